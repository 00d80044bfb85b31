:- module(test_attackers, []).

% Attackers are separate programs: they share no process with their victims,
% and have only the protocol and keys.

:- use_module('../../../lib/authority').
:- use_module('../../../lib/common').
:- use_module('../../../lib/peers').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(typhon)).

:- needs([openssl]).

:- meta_predicate with_attacker(2), with_attacker(2, +).

%   alpha is here, beta in a process with the same authority, and mallory is
%   the attacker: call(Goal, Mallory, Host), where Host is its address.

with_attacker(Goal) :-
    with_authority([alpha, beta, mallory], [], with_attacker(Goal)).

with_attacker(Goal, Authority) :-
    keys_of(alpha, Authority, Alpha),
    keys_of(beta, Authority, Beta),
    keys_of(mallory, Authority, Mallory),
    project_file('test/lib/attacker.pl', File),
    with_peers([beta-[host([tls(Beta)])]],
        with_swipl([File, Mallory], _, In, Out,
            ( read_term(Out, Endpoint, []),
              atomic_list_concat([den, Endpoint], @, Host),
              setup_call_cleanup(
                  host_start(alpha, [tls(Alpha)]),
                  once(call(Goal, In-Out, Host)),
                  host_stop(alpha)) ))).

%   does(+Mallory, +Command, -Answer)

does(In-Out, Command, Answer) :-
    format(In, '~q.~n', [Command]),
    flush_output(In),
    read_term(Out, Answer, []).

%   The Nth agent that goes to beta, where it enters a result, and to mallory.

guest(Mallory, Host, Nth, Agent) :-
    peer_host(beta, Beta),
    agent_create(clauses([ (:- agent(guest, [state([to/1, seen/1])])),
                           (main :- retract(to(H)), !, move(H), here(Here),
                                    assertz(seen(Here)), enter(was(Here)),
                                    main),
                           main,
                           (on_message(_, go(H)) :- move(H)),
                           (on_message(_, remember(X)) :- assertz(seen(X))) ]),
                 Agent, [facts([to(Beta), to(Host)])]),
    wait_until(( does(Mallory, had, had(Count)), Count >= Nth ), 20).

%   sent(+Mallory, +Host, +Nth, +Change, -Answer): to Host, alpha or beta.

sent(Mallory, Host, Nth, Change, Answer) :-
    host_endpoint(Host, Endpoint),
    does(Mallory, send(Endpoint, Host, Nth, Change), answer(Answer)).

host_endpoint(alpha, Endpoint) :-
    host_property(alpha, address(Address)),
    atomic_list_concat([_, Endpoint], @, Address).
host_endpoint(beta, Endpoint) :-
    peer_host(beta, Address),
    atomic_list_concat([_, Endpoint], @, Address).

resides(Agent, Host) :-
    wait_until(( agent_property(Agent, host(Host)),
                 agent_property(Agent, state(resident)) ), 20).

:- begin_tests(attackers).

test(expired_certificate_is_refused) :-
    with_authority([alpha, beta, delta], [], test_attackers:expired).
test(removed_link_is_detected) :-
    with_attacker(test_attackers:links_removed).
test(replayed_image_creates_no_second_agent) :-
    with_attacker(test_attackers:sent_again).

:- end_tests(attackers).

%   The client is that of OpenSSL: it greets as a process of Typhon does, and
%   prints the answer. With a valid certificate that is a greeting.

expired(Authority) :-
    expired_host(Authority, delta),
    keys_of(alpha, Authority, Dir),
    setup_call_cleanup(
        host_start(alpha, [tls(Dir)]),
        ( host_endpoint(alpha, Endpoint),
          greets(Authority, beta, Endpoint, Welcome),
          greets(Authority, delta, Endpoint, Refusal) ),
        host_stop(alpha)),
    assertion(sub_string(Welcome, _, _, _, "typhon 3 ")),
    assertion(\+ sub_string(Refusal, _, _, _, "typhon 3 ")),
    assertion(sub_string(Refusal, _, _, _, "certificate expired")).

greets(Authority, Name, Endpoint, Told) :-
    keys_of(Name, Authority, Dir),
    directory_file_path(Dir, 'cert.pem', Certificate),
    directory_file_path(Dir, 'key.pem', Key),
    setup_call_cleanup(
        process_create(path(openssl),
                       [ s_client, '-connect', Endpoint, '-tls1_3', '-quiet',
                         '-cert', Certificate, '-key', Key ],
                       [ stdin(pipe(In)), stdout(pipe(Out)),
                         stderr(pipe(Err)), process(Pid) ]),
        ( catch(( format(In, "typhon 3 ~`0t~32| x 1 127.0.0.1:1 90004 64 \c
                              none~n", []),
                  flush_output(In) ), error(_, _), true),
          read_string(Out, _, Said),    % until the host's wait has ended
          read_string(Err, _, Errors) ),
        ( catch(close(In, [force(true)]), error(_, _), true),
          close(Out),
          close(Err),
          process_wait(Pid, _) )),
    string_concat(Said, Errors, Told).

%   mallory signs nothing, so nothing is accounted for after beta; without the
%   link of beta, nothing after alpha. Without that of alpha the numbers of the
%   steps show that there were earlier ones.

links_removed(Mallory, Host) :-
    forall(nth1(Nth, [ next-beta-[0,1,2,3], unlinked(2)-alpha-[0],
                       unlinked(1)-beta-[3] ],
                Change-Last-Numbers),
           ( guest(Mallory, Host, Nth, Agent),
             sent(Mallory, alpha, Nth, Change, Answer),
             assertion(Answer == accepted),
             resides_at(alpha, Agent),
             agent_trail(Agent, trail(Steps, Verdict)),
             findall(Number, member(step(Number, _, _), Steps), Told),
             assertion(Change-Verdict-Told
                       == Change-unaccounted(Last)-Numbers) )).

resides_at(alpha, Agent) :-
    host_property(alpha, address(Alpha)),
    resides(Agent, Alpha).

%   The host of the agent, the hosts that it has visited, and the host where it
%   has ended. A host without newer news of an agent cannot know that an image
%   is old: beta does not know of the third hop until the agent comes back.

sent_again(Mallory, Host) :-
    guest(Mallory, Host, 1, Agent),
    sent(Mallory, alpha, 1, next, First),
    assertion(First == accepted),
    resides_at(alpha, Agent),
    agent_send(Agent, remember(new)),
    wait_until(remembers(Agent), 20),
    again(Mallory, [alpha-none, alpha-next, beta-none], 1-0),
    assertion(remembers(Agent)),
    peer_host(beta, Beta),
    agent_send(Agent, go(Beta)),
    resides(Agent, Beta),
    every_way(Ways),
    again(Mallory, Ways, 0-1),
    assertion(remembers(Agent)),
    agent_dispose(Agent),
    agent_join(Agent, Outcome, 20),
    assertion(Outcome == disposed),
    again(Mallory, Ways, 0-0).

every_way([alpha-none, alpha-next, beta-none, beta-next]).

remembers(Agent) :-
    agent_property(Agent, facts(Facts)),
    memberchk(seen(new), Facts).

%   again(+Mallory, +Ways, +Loads): an image that mallory has received, or has
%   sent before, is recognised as a repetition: the loads of alpha and beta
%   stay the same.

again(Mallory, Ways, Loads) :-
    forall(member(Host-Change, Ways),
           ( sent(Mallory, Host, 1, Change, Answer),
             assertion(Host-Change-Answer == Host-Change-accepted) )),
    peer_host(beta, Beta),
    host_property(alpha, load(Here)),
    host_property(Beta, load(There)),
    assertion(Here-There == Loads).
