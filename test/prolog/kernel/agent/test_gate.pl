:- module(test_gate, []).

% Each reason to refuse an agent, on each path of admission: the same reason
% reaches the program, the audit file and the watchers of the host.

:- use_module('../../../lib/authority').
:- use_module('../../../lib/common').
:- use_module('../../../lib/peers').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(typhon)).

:- needs([openssl]).

:- meta_predicate watched(0, -).

:- dynamic event/1.

                /*******************************
                *           THE TABLE          *
                *******************************/

%   path(?Path, ?Source, ?Way): the agent that hops to host inn, or starts
%   there, is sent by this process (here) or by the process far (there).

path(create_here, here, create).
path(restore_here, here, restore).
path(hop_here, here, hop).
path(clone_here, here, clone).          % to inn, from another host
path(clone_on, here, clone_on).         % of an agent on inn
path(create_there, there, create).
path(restore_there, there, restore).
path(hop_there, there, hop).
path(clone_there, there, clone).

%   reason(?Reason, ?Option): inn has that Option, or `all` of them, and then
%   the first reason counts.

reason(peer, peer([certificate(alpha)-all, certificate(_)-[messages, watch]])).
reason(policy(shell(ls)), policy(guarded)).
reason(policy(shell(ls)), all([ capacity(0), tokens([red]), authors([alice]),
                                quota([state(1000)]), policy(guarded) ])).
reason(quota(mailbox), quota([mailbox(1)])).
reason(quota(state), quota([state(1000)])).
reason(quota(agents), quota([owner(agents(1))])).
reason(unsigned, authors([alice])).
reason(token, tokens([red])).
reason(capacity, capacity(0)).

%   Only another process can lack a right; a clone has no messages, nor has a
%   new agent; an agent on inn ends if its state is too large.

cell(Path, Reason, Option) :-
    path(Path, Source, Way),
    reason(Reason, Option),
    ( Reason == peer -> Source == there ; true ),
    ( ends_too_large(Option) -> Way \== clone_on ; true ),
    ( Reason == quota(mailbox) -> memberchk(Way, [hop, restore]) ; true ).

ends_too_large(quota([state(_)])).
ends_too_large(all(_)).

                /*******************************
                *            A CELL            *
                *******************************/

%   refused(+Path, +Reason, +Option, -Told, -Audited, -Events, +Dir): the
%   result of the attempt, and its records as From-Agent-Reason and
%   Agent-Reason.

refused(Path, Reason, Option, Told, Audited, Events, Dir) :-
    path(Path, Source, Way),
    directory_file_path(Dir, audit, File),
    setup_call_cleanup(
        host_start(inn, [audit(File), cell(none)]),
        ( host_property(inn, address(Inn)),
          prepared(Reason, Option, Way, Source, Agent),
          changed(Option),
          watched(attempt(Way, Source, Agent, Inn, Told), Events) ),
        host_stop(inn)),
    findall(Peer-Proof-Refused-Why,
            audit_line(File, Peer, Proof, refused(Refused, Why)), Audited).

changed(all(Options)) :-
    !,
    forall(member(Option, Options), host_change(inn, Option)).
changed(Option) :-
    host_change(inn, Option).

audit_line(File, Peer, Proof, What) :-
    exists_file(File),
    read_file_to_terms(File, Lines, []),
    member(audit(_, inn, Peer, Proof, What), Lines).

%   prepared(+Reason, +Option, +Way, +Source, -Agent): Agent is on the host
%   where its way begins, or is `none`. If an owner may have one agent, the
%   owner has one on inn.

prepared(quota(agents), Option, Way, Source, Agent) :-
    !,
    host_change(inn, Option),
    host_property(inn, address(Inn)),
    (   Way == clone_on
    ->  guest(here, inn, Agent)
    ;   guest(Source, Agent),
        (   memberchk(Way, [create, restore])
        ->  guest(Source, Inn, _)
        ;   guest(Source, Other),
            agent_send(Other, go(hop, Inn)),
            wait_until(agent_property(Other, host(Inn)), 20)
        )
    ).
prepared(_, _, clone_on, _, Agent) :-
    !,
    guest(here, inn, Agent).
prepared(_, _, _, Source, Agent) :-
    guest(Source, Agent).

%   Two messages wait for an agent, and its state has some size.

guest(Source, Agent) :-
    home(Source, Home),
    guest(Source, Home, Agent).

guest(Source, Host, Agent) :-
    program(Program, Facts),
    on(Source, agent_create(Program, Agent, [host(Host), facts(Facts)])),
    forall(member(N, [1, 2]), agent_send(Agent, waits(N))),
    wait_until(agent_property(Agent, state(waiting)), 20).

home(here, home).
home(there, far).

on(here, Goal) :-
    call(Goal).
on(there, Goal) :-
    peer_do(far, Goal).

program(clauses([ (:- agent(guest, [state([note/2])])),
                  (main :-
                      receive(_-go(Way, To)),
                      catch(leaves(Way, To), error(Formal, _), true),
                      result(Formal),
                      stays(Formal)),
                  (stays(Formal) :- nonvar(Formal), !),
                  (stays(_) :- receive(_-never)),
                  (leaves(hop, To) :- move(To)),
                  (leaves(clone, To) :- clone(To, _)),
                  (leaves(clone_on, _) :- clone(_)),
                  (idle :- shell(ls)) ]), Facts) :-
    findall(note(N, text), between(1, 100, N), Facts).

%   attempt(+Way, +Source, +Agent, +Inn, -Told)

attempt(create, Source, _, Inn, Told) :-
    !,
    program(Program, Facts),
    verdict(on(Source, agent_create(Program, _, [host(Inn), facts(Facts)])),
            Told).
attempt(restore, Source, Agent, Inn, Told) :-
    !,
    tmp_file(guest, File),
    setup_call_cleanup(
        agent_save(Agent, File),
        verdict(on(Source, agent_load(File, _, [host(Inn)])), Told),
        delete_file(File)).
attempt(Way, _, Agent, Inn, Told) :-
    agent_send(Agent, go(Way, Inn)),
    agent_result(Agent, Told, 20).

:- meta_predicate verdict(0, -).

verdict(Goal, Told) :-
    catch(( call(Goal), Told = admitted ), error(Formal, _), Told = Formal).

watched(Goal, Events) :-
    retractall(event(_)),
    setup_call_cleanup(
        watch(inn, note_event, Watch),
        once(Goal),
        with_settings([typhon_watches:last_seconds=20], unwatch(Watch))),
    findall(Refused-Why, event(event(_, _, none, refused(Refused, Why))), Events).

note_event(Event) :-
    assertz(event(Event)).

                /*******************************
                *             TESTS            *
                *******************************/

with_processes(Goal) :-
    with_authority([alpha, beta], [alice], with_processes(Goal)).

:- meta_predicate with_processes(0), with_processes(0, +).

with_processes(Goal, Authority) :-
    keys_of(alpha, Authority, Alpha),
    keys_of(beta, Authority, Far),
    with_peers([far-[host([tls(Far)])]],
               setup_call_cleanup(host_start(home, [tls(Alpha)]),
                                  once(Goal),
                                  host_stop(home))).

%   Proof is of the process that Source names.

expected(Path, Reason, move_refused(Inn, Reason), Peer-certificate(Name)) :-
    path(Path, Source, _),
    home(Source, Home),
    (   Source == here
    ->  Name = alpha, host_property(home, address(Address))
    ;   Name = beta, peer_host(Home, Address)
    ),
    typhon_host:address_parts(Address, _, Peer),
    host_property(home, address(HomeAddress)),
    typhon_host:address_parts(HomeAddress, _, Own),
    typhon_host:address_parts(Inn, inn, Own).

is_guest(Refused) :-
    atom(Refused),
    sub_atom(Refused, 0, _, _, guest).

deviates(Path, Reason, got(Told, Audited, Events)) :-
    cell(Path, Reason, Option),
    with_tmp_dir(refused(Path, Reason, Option, Told, Audited, Events)),
    expected(Path, Reason, Refusal, Proved),
    \+ ( Told = Refusal,
         Audited = [Proved-Refused-Reason],
         Events = [Refused-Reason],
         is_guest(Refused) ).

%   The process far may send anything.

requests_made(Dir) :-
    directory_file_path(Dir, audit, File),
    setup_call_cleanup(
        host_start(inn, [audit(File), tokens([red])]),
        forall(request(Case, Kind, Request, Answer, Audited),
               ( asked(Kind, Request, Got),
                 assertion((Case-Got) = (Case-answer(Answer))),
                 findall(What, audit_line(File, _, _, What), Lines),
                 ( exists_file(File) -> delete_file(File) ; true ),
                 assertion((Case-Lines) = (Case-Audited)) )),
        host_stop(inn)),
    far_image(image(_, Hash, _, _, _, _, _), _),
    assertion(\+ typhon_code:code_module(Hash, _)).

asked(Kind, Request, Answer) :-
    host_property(home, address(Home)),
    typhon_host:address_parts(Home, _, Endpoint),
    peer_do(far, typhon_wire:endpoint_call(Endpoint, Kind, Request, Answer,
                                           10)).

%   An agent of a program that only far has.

far_image(Image, Sent) :-
    peer_do(far,
            ( agent_create(clauses([ (:- agent(rare, [])),
                                     on_message(_, only_far) ]), A),
              typhon_image:image_hop(A, _, [], [], 0, Image),
              typhon_image:image_hash(Image, Hash),
              typhon_code:code_sent(Hash, Code) )),
    birth_signed(far, A, Hash, Birth),
    Sent = papers(Birth, Code).

%   request(-Case, -Kind, -Request, -Answer, -Audited)

request(no_such_host, hop, hop(nowhere, Image, Sent), refused(unknown_host),
        []) :-
    far_image(Image, Sent).
request(any_host, hop, hop(_, Image, Sent), refused(unknown_host), []) :-
    far_image(Image, Sent).
request(begin_on_any_host, agent, create(_, x, Start, Code),
        refused(unknown_host), []) :-
    far_start(Start, Code).
request(name_of_another_owner, agent, create(inn, Name, Start, Code),
        refused(error(domain_error(agent_name, Name))),
        [refused(malformed, error(domain_error(agent_name, Name)))]) :-
    Name = 'x.1-alpha.0@home',
    far_start(Start, Code).
request(no_agent, hop, hop(inn, f(x), known),
        refused(error(type_error(agent_image, f/1))),
        [refused(malformed, error(type_error(agent_image, f/1)))]).
request(id_of_another_owner, hop,
        hop(inn, image('x.1-alpha.0@home@h:1', H, L, S, G, M, T), Sent),
        refused(identity), [refused('x.1-alpha.0@home@h:1', identity)]) :-
    far_image(image(_, H, L, S, G, M, T), Sent).

far_start(start(Hash, Life, State, [], []), Code) :-
    far_image(image(_, Hash, Life, State, _, _, _), papers(_, Code)).

:- begin_tests(gate).

test(each_refusal_is_reported_audited_and_an_event, Deviations == []) :-
    no_leaks(with_processes(
                 findall(Path-Reason-Got, deviates(Path, Reason, Got),
                         Deviations))).
test(forged_requests_are_refused) :-
    with_processes(with_tmp_dir(requests_made)).

%   In a process of its own, which may have little address space.

test(clone_bomb_does_not_end_the_process, Out == "well, capacity\n") :-
    project_file('test/lib/clone_bomb.pl', File),
    current_prolog_flag(executable, Swipl),
    format(atom(Command), 'ulimit -v 2500000; exec "~w" "~w"', [Swipl, File]),
    setup_call_cleanup(
        process_create(path(sh), ['-c', Command],
                       [ stdin(null), stdout(pipe(Pipe)), stderr(null) ]),
        read_string(Pipe, _, Out),
        close(Pipe)).

:- end_tests(gate).
