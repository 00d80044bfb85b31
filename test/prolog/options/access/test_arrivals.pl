:- module(test_arrivals, []).

/** <module> What other processes send is checked against the declarations

Each declared term is sent to a host by a process with no right, with each one,
and with all, which proves itself by the cookie, by the certificate of the host,
and by that of a stranger.

*Threading*: one test at a time.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/arrivals').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/fixtures', [capturing/2, was_printed/2]).
:- use_module('../../../lib/peers').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/host), [address_parts/3]).
:- use_module(library(typhon/kernel/wire),
              [ endpoint_address/1, endpoint_call/5, endpoint_post/3,
                endpoint_process/1, endpoint_request/4 ]).

:- begin_tests(arrivals).

test(cookie_decides_by_rights) :-
    with_tmp_dir(by_cookie(all_rights)).
test(unknown_or_malformed_terms_are_refused_and_audited) :-
    with_tmp_dir(by_cookie(malformed)).
test(peer_without_rights_changes_nothing) :-
    with_tmp_dir(by_cookie(unchanged)).
test(messages_for_agents_elsewhere_need_the_right_on_all_hosts) :-
    with_tmp_dir(by_cookie(forwarded)).
test(first_rule_that_matches_applies) :-
    with_tmp_dir(by_cookie(first_rule)).
test(child_of_a_network_obeys_its_parent_only,
     Answers-Done == [not_permitted(parent), lost]-none) :-
    no_leaks(child_attacked(Answers, Done)).
test(channels_are_of_the_process_that_posts_and_few,
     Others-Own == 0-16) :-
    no_leaks(channels(Others, Own)).
test(forged_traces_and_events_are_not_shown, Shown == []) :-
    no_leaks(forged_events(Shown)).
test(posts_to_others_are_not_acknowledged, Left == [n(1)]) :-
    no_leaks(with_peers([p-[host([])]],
                        with_host_here([], acknowledged(Left)))).

test(term_that_is_not_declared_is_reported) :-
    no_leaks(capturing(with_peers([p-[host([])]], with_host_here([], reported)),
                       _)).

:- end_tests(arrivals).

reported :-
    endpoint_address(Me),
    peer_do(p, typhon_wire:endpoint_post(Me, bogus, x)),
    wait_until(was_printed(warning,
                           typhon(endpoint, undeclared(_, post, bogus))), 10).

:- begin_tests(arrivals_by_certificate, [condition(has_openssl)]).

test(certificate_of_the_host_decides_by_rights) :-
    with_authority([alpha, beta], [], by_certificate(alpha)).
test(certificate_of_a_stranger_decides_by_rights) :-
    with_authority([alpha, beta], [], by_certificate(beta)).
test(stranger_without_rules_may_not_run_goals_or_write_logs) :-
    with_authority([alpha, beta], [], default_rights).

:- end_tests(arrivals_by_certificate).

has_openssl :-
    catch(absolute_file_name(path(openssl), _, [access(execute)]),
          error(_, _), fail).

                /*******************************
                *            VICTIM            *
                *******************************/

by_cookie(Test, Dir) :-
    directory_file_path(Dir, audit, File),
    no_leaks(with_peers(
        [p-[host([audit(File), peer([cookie-[]])])]],
        with_host_here([], call(Test, cookie, File)))).

by_certificate(Holder, Authority) :-
    keys_of(alpha, Authority, Inn),
    keys_of(Holder, Authority, Keys),
    with_tmp_dir(by_certificate(Inn, Keys, certificate(Holder))).

by_certificate(Inn, Keys, Proof, Dir) :-
    directory_file_path(Dir, audit, File),
    no_leaks(with_peers(
        [p-[host([tls(Inn), cell(none), audit(File), peer([Proof-[]])])]],
        with_host_here([tls(Keys)], all_rights(Proof, File)))).

default_rights(Authority) :-
    keys_of(alpha, Authority, Inn),
    keys_of(beta, Authority, Keys),
    with_tmp_dir(default_rights(Inn, Keys)).

default_rights(Inn, Keys, Dir) :-
    directory_file_path(Dir, audit, File),
    no_leaks(with_peers(
        [p-[host([tls(Inn), cell(none), audit(File)])]],
        with_host_here([tls(Keys)],
                       ( refusals(File, Refused, _),
                         sort(Refused, Rights),
                         assertion(Rights == [log,parent,remote]) )))).

:- meta_predicate with_host_here(+, 0).

with_host_here(Options, Goal) :-
    setup_call_cleanup(host_start(here, Options), once(Goal),
                       host_stop(here)).

                /*******************************
                *            MATRIX            *
                *******************************/

rights([agents, messages, orders, remote, watch, log]).

all_rights(Proof, File) :-
    rights(Rights),
    forall(( Given = [] ; member(Right, Rights), Given = [Right]
           ; Given = all ),
           obeys(Given, Proof, File)).

obeys(Given, Proof, File) :-
    peer_do(p, host_change(p, peer([Proof-Given]))),
    refusals(File, Refused, Needed),
    expected(Needed, Given, Expected),
    assertion(Refused == Expected).

expected([], _, []).
expected([Right|Needed], Given, Refused) :-
    (   may(Right, Given)
    ->  Refused = More
    ;   Refused = [Right|More]
    ),
    !,
    expected(Needed, Given, More).

may(Right, all) :-
    Right \== parent.
may(Right, Given) :-
    is_list(Given),
    memberchk(Right, Given).

%   refusals(+File, -Refused, -Needed): send all declared terms.  Refused are
%   the rights that were audited as missing, Needed those declared, in order.

refusals(File, Refused, Needed) :-
    waiting_agent(Agent),
    findall(case(Form, Kind, Term, Right),
            arrival_sample(p, Agent, Form, Kind, Term, Right), Cases),
    audited(File, Before),
    forall(member(case(Form, Kind, Term, _), Cases), sent(Form, Kind, Term)),
    audited(File, After),
    append(Before, New, After),
    findall(Right, member(refused(Right), New), Refused),
    findall(Right,
            ( member(case(_, _, _, Right), Cases),
              \+ memberchk(Right, [none, asked, gate]) ),
            Needed).

%   A later request is answered after all that was sent before.

sent(Form, Kind, Term) :-
    endpoint(p, Endpoint),
    (   Form == post
    ->  endpoint_post(Endpoint, Kind, Term)
    ;   endpoint_request(Endpoint, Kind, Term, test_arrivals:ignored)
    ),
    endpoint_call(Endpoint, certificate, of_yours, _, 20).

ignored(_).

endpoint(Peer, Endpoint) :-
    peer_host(Peer, Host),
    address_parts(Host, _, Endpoint).

audited(File, Whats) :-
    (   exists_file(File)
    ->  read_file_to_terms(File, Entries, [])
    ;   Entries = []
    ),
    findall(What, member(audit(_, _, _, _, What), Entries), Whats).

waiting_agent(Agent) :-
    peer_do(p, agent_create(clauses([ (:- agent(x, [])),
                                      on_message(_, _) ]), Agent)).

                /*******************************
                *           CHILDREN           *
                *******************************/

%   A process that knows the cookie gives orders to the children of a network.

child_attacked(Answers, Done) :-
    with_peers([p-[host([])]],
               setup_call_cleanup(
                   network_start(ring(2), Network, [processes(2)]),
                   attacked(Network, Answers, Done),
                   network_stop(Network))).

attacked(Network, [Guessed,Without], Done) :-
    network_property(Network, hosts(Hosts)),
    member(Host, Hosts),
    address_parts(Host, Name, Child),
    \+ endpoint_address(Child),
    !,
    Places = places([Name-leave(attacked)]),
    node_answers(Child, order(guess, Places), Guessed),
    node_answers(Child, Places, Without),
    ( remote(Host, sense(attacked)) -> Done = attacked ; Done = none ).

                /*******************************
                *            CHANNELS          *
                *******************************/

%   Channels of a process that posts to forty addresses of this one, and in the
%   name of another process.

channels(Others, Own) :-
    with_peers([p-[host([])]],
               with_host_here([], channels_there(Others, Own))).

channels_there(Others, Own) :-
    endpoint_process(Process),
    forall(between(1, 40, I),
           ( posted(other, I), posted(Process, I) )),
    wait_until(seen_of(Process, 16), 20),
    posted(Process, 41),
    seen_of(other, Others),
    seen_of(Process, Own).

posted(Process, I) :-
    atom_concat(address, I, To),
    sent(post, channel, channel(Process, To, first(-1), 0, bogus, x)).

%   The peer loads the code of channels when the first post comes.

seen_of(Process, Count) :-
    peer_do(p, aggregate_all(count,
                             ( typhon_durable:durable_dump(seen, Key, _, _),
                               sub_atom(Key, 0, _, _, Process) ),
                             Count0)),
    Count = Count0.

                /*******************************
                *      WHAT WAS NOT ASKED FOR  *
                *******************************/

%   The process `p` watches its host and traces an agent of its own, so that the
%   code is loaded; this one sends events to that watch, and traces of another
%   agent.

forged_events(Shown) :-
    with_peers([p-[host([])]],
               with_host_here([], forged_events_there(Shown))).

forged_events_there(Shown) :-
    waiting_agent(Agent),
    peer_do(p, agent_trace(Agent, [messages])),
    peer_do(p, assertz(( test_seen:note(E) :- assertz(test_seen:noted(E)) ))),
    peer_do(p, watch([p], test_seen:note, Watch)),
    peer_do(p, remote(p, leave(real))),
    Event = event(0, forged, none, log(forged)),
    sent(request, watched, events(Watch, [Event])),
    sent(request, trace, traced(forged, forged, hop)),
    peer_do(p, unwatch(Watch)),         % delivers earlier events
    peer_do(p, findall(E, test_seen:noted(E), Events)),
    assertion(memberchk(event(_, _, _, leave(real)), Events)),
    peer_messages(p, Lines),
    findall(Line, ( member(Line, Lines), sub_atom(Line, _, _, _, forged) ),
            Printed),
    findall(Event, member(Event, Events), Forged),
    append(Forged, Printed, Shown).

%   `p` keeps a post for another process; this process says that it has come.

acknowledged(Left) :-
    peer_do(p, use_module(library(typhon/options/journal/channel), [])),
    peer_do(p, typhon_durable:durable_restore(out, '10.0.0.1:1', 1,
                                              item(note, n(1)))),
    sent(post, channel, had('10.0.0.1:1', 5)),
    sent(post, channel, again('10.0.0.1:1')),
    sent(post, channel, channel(x, x, first(-1), 0, bogus, x)),
    peer_do(p, findall(Term, typhon_durable:durable_dump(out, '10.0.0.1:1', _,
                                                         item(_, Term)),
                       Left)).

node_answers(Child, Term, Answer) :-
    peer_do(p, catch(typhon_wire:endpoint_call(Child, node, Term,
                                               answer(Answer), 20),
                     error(connection_lost(_), _),
                     Answer = lost)).

                /*******************************
                *          MALFORMED           *
                *******************************/

%   Each term of the declarations with each argument of a wrong type, and terms
%   that are not declared at all.

malformed(_, File) :-
    peer_do(p, host_change(p, peer([cookie-all]))),
    findall(case(Form, Kind, Term),
            ( arrival_sample(p, x, Form, Kind, Term0, _), damaged(Term0, Term),
              \+ declared(Form, Kind, Term) ),
            Cases0),
    append(Cases0,
           [ case(request, bogus, x), case(post, bogus, x), case(post, _, x),
             case(request, f(x), x), case(request, node, x),
             case(request, hosting, _), case(post, message, _) ],
           Cases),
    length(Cases, Count),
    assertion(Count > 100),
    forall(member(case(Form, Kind, Term), Cases),
           refused_undeclared(Form, Kind, Term, File)).

refused_undeclared(Form, Kind, Term, File) :-
    audited(File, Before),
    sent(Form, Kind, Term),
    audited(File, After),
    append(Before, New, After),
    assertion(Form-Kind-Term-New = _-_-_-[undeclared(_)]).

damaged(Term0, Term) :-
    compound(Term0),
    Term0 \= [_|_],
    compound_name_arguments(Term0, Name, Args0),
    nth1(I, Args0, _),
    member(Wrong, [_, f(_), 1.5, "text"]),
    findall(Arg, ( nth1(J, Args0, Arg0), ( I == J -> Arg = Wrong ; Arg = Arg0 )
                 ), Args),
    compound_name_arguments(Term, Name, Args).

declared(Form, Kind, Term) :-
    typhon_kinds:accepts(Form, Kind, Term, _, _),
    !.

                /*******************************
                *           UNCHANGED          *
                *******************************/

%   The state of an agent and of the host that the terms are about.

unchanged(Proof, File) :-
    waiting_agent(Agent),
    state(Agent, Before),
    obeys([], Proof, File),
    state(Agent, After),
    assertion(After == Before).

state(Agent, [Status,Links,Facts,Whereabouts]) :-
    peer_do(p, agent_property(Agent, state(Status))),
    peer_do(p, host_property(p, neighbours(Links))),
    peer_do(p, findall(Fact, remote(p, sense(Fact)), Facts)),
    peer_do(p, agent_property(Agent, host(Whereabouts))).

%   Otherwise a host would forward what a peer may not send itself.

forwarded(_, File) :-
    Ghost = 'ghost.1.0@elsewhere@127.0.0.1:1',
    sent(post, message, message(Ghost, [mail('127.0.0.1:1', user, x)], 3)),
    audited(File, Whats),
    assertion(Whats == [refused(messages)]).

first_rule(_, File) :-
    peer_do(p, host_change(p, peer([cookie-[watch], cookie-all]))),
    refusals(File, Refused, Needed),
    expected(Needed, [watch], Expected),
    assertion(Refused == Expected).
