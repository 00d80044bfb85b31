:- module(test_user_errors, []).
:- use_module(library(plunit)).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/2, message_text/2]).
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/top_level').
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(time)).
:- use_module(library(typhon)).

/** <module> Errors of calls with wrong arguments

Every exported predicate of library(typhon) is called with a variable and with
terms of the wrong type in place of each input.
*/

%   valid(-Goal, -Inputs): Goal would be a call without mistakes, where alpha is
%   a host, bob an agent, and net a network; the others are not reached. Inputs
%   are the names of its inputs: the others may be unbound.

valid(agent_change(bob, facts([])), ['Agent', 'Change']).
valid(agent_check(clauses([])), ['Spec']).
valid(agent_check(clauses([]), []), ['Spec', 'Options']).
valid(agent_clone(bob, _), ['Agent']).
valid(agent_create(none, _), ['Program']).
valid(agent_create(none, _, [host(alpha)]), ['Program', 'Options']).
valid(agent_dispose(nobody), ['Agent']).
valid(agent_dispose(nobody, []), ['Agent', 'Options']).
valid(agent_join(nobody, _, 0.1), ['Agents', 'Timeout']).
valid(agent_listing(nobody), ['Agent']).
valid(agent_load(none, _), ['File']).
valid(agent_load(none, _, []), ['File', 'Options']).
valid(agent_monitor(nobody, [_,_]>>true), ['Agent', 'OnDown']).
valid(agent_move(bob, alpha), ['Agent', 'Host']).
valid(agent_move(bob, alpha, []), ['Agent', 'Host', 'Options']).
valid(agent_notrace(nobody), ['Agent']).
valid(agent_property(bob, state(_)), []).
valid(agent_result(nobody, _, 0.1), ['Agent', 'Timeout']).
valid(agent_resume(nobody), ['Agent']).
valid(agent_save(bob, '/nowhere/bob'), ['Agent', 'File']).
valid(agent_send(bob, x), ['Agent']).
valid(agent_step(bob), ['Agent']).
valid(agent_trace(bob, [hops]), ['Agent', 'What']).
valid(agent_trail(bob, _), ['Agent']).
valid(agent_where(bob, _), ['Agent']).
valid(fipa_start(alpha, 'http://localhost:0', []), ['Host', 'URL', 'Options']).
valid(fipa_stop(nowhere), ['Host']).
valid(fleet_drain(alpha, []), ['Host', 'Options']).
valid(fleet_hosts(lab, _, []), ['Fleet', 'Options']).
valid(fleet_join(lab, [redis('127.0.0.1':1)]), ['Fleet', 'Options']).
valid(fleet_leave(lab), ['Fleet']).
valid(fleet_parked(lab, _), ['Fleet']).
valid(fleet_unwatch(none), ['Watch']).
valid(fleet_watch(lab, [_]>>true, _), ['Fleet', 'OnChange']).
valid(gpio_start(alpha, [a=output(1)], [python('/no/such')]),
      ['Host', 'Pins', 'Options']).
valid(gpio_stop(nowhere), ['Host']).
valid(host_change(alpha, capacity(3)), ['Host', 'Option']).
valid(host_property(alpha, state(_)), []).
valid(host_start(alpha), ['Name']).
valid(host_start(alpha, []), ['Name', 'Options']).
valid(host_stop(nowhere), ['Name']).
valid(link(alpha, nowhere), ['A', 'B']).
valid(link(alpha, nowhere, []), ['A', 'B', 'Options']).
valid(log_events(none, _), ['File']).
valid(log_server_start([], _), ['Options']).
valid(log_server_stop('log@127.0.0.1:1'), ['Address']).
valid(mqtt_start(alpha, 'mqtt://nowhere.invalid', []),
      ['Host', 'URL', 'Options']).
valid(mqtt_stop(nowhere), ['Host']).
valid(network_advance(net, 0), ['Network', 'Seconds']).
valid(network_at(net, 0, true), ['Network', 'Time', 'Goal']).
valid(network_load(none, _, []), ['File', 'Options']).
valid(network_property(net, seed(_)), []).
valid(network_save(net, '/nowhere/net'), ['Network', 'File']).
valid(network_start(none, _, []), ['Topology', 'Options']).
valid(network_stop(none), ['Network']).
valid(page_start([bind(nowhere)]), ['Options']).
valid(people_revoke(nobody), ['Name']).
valid(people_start([anna], [bind(nowhere)]), ['Names', 'Options']).
valid(people_start([anna], _, [bind(nowhere)]), ['Names', 'Options']).
valid(payload_attach(bob, none), ['Agent', 'Payload']).
valid(payload_detach(bob, none), ['Agent', 'Name']).
valid(python_start(alpha, none, []), ['Host', 'File', 'Options']).
valid(python_stop(nowhere), ['Host']).
valid(remote(alpha, true), ['Host', 'Goal']).
valid(ros_property(alpha, state(_)), []).
valid(ros_start(alpha, 'ws://nowhere.invalid', []),
      ['Host', 'Where', 'Options']).
valid(ros_stop(nowhere), ['Host']).
valid(unlink(alpha, nowhere), ['A', 'B']).
valid(unwatch(none), ['Watch']).
valid(watch(alpha, [_]>>true, _), ['Hosts', 'OnEvent']).
valid(work_done(lab, tasks, work('0-1', 1, t), r),
      ['Fleet', 'Queue', 'Work', 'Result']).
valid(work_keep(lab, tasks, me, work('0-1', 1, t)),
      ['Fleet', 'Queue', 'Worker', 'Work']).
valid(work_left(lab, tasks, _), ['Fleet', 'Queue']).
valid(work_put(lab, tasks, [t]), ['Fleet', 'Queue', 'Tasks']).
valid(work_results(lab, tasks, _), ['Fleet', 'Queue']).
valid(work_take(lab, tasks, me, _), ['Fleet', 'Queue', 'Worker']).

%   Any term is a message, and a goal that fails is one that is called.

accepts(agent_send/2, 2, _).
accepts(network_at/3, 3, _).
accepts(network_advance/2, 2, T) :- number(T).
accepts(network_at/3, 2, T) :- number(T).
accepts(agent_join/3, 3, T) :- number(T).
accepts(agent_result/3, 3, T) :- number(T).
accepts(agent_trail/2, 2, _).           % an answer
accepts(agent_where/2, 2, _).
accepts(work_done/4, 4, _).             % any result
accepts(watch/3, 2, Goal) :- callable(Goal).
accepts(remote/2, 2, f(_)).

                /*******************************
                *             FILES            *
                *******************************/

%   file_call(+Name, -Goal): Goal reads or writes the file or directory Name, in
%   this order.

file_call(F, agent_check(F)) :- F = "hi.pl".
file_call(F, agent_create(F, _, [name(ann), host(alpha)])) :- F = "hi.pl".
file_call(F, payload_attach(ann, F)) :- F = "pay.pl".
file_call(F, agent_save(ann, F)) :- F = "ann".
file_call(F, agent_load(F, _, [host(alpha)])) :- F = "ann".
file_call(F, started(beta, consult(F))) :- F = "facts.pl".
file_call(F, started(beta, policy(F))) :- F = "rules.pl".
file_call(F, started(beta, audit(F))) :- F = "audit".
file_call(F, logged([log(F), places([F2])], Net)) :-
    F = "run.log", F2 = "facts.pl", Net = "net".
file_call(F, log_events(F, _)) :- F = "run.log".

:- public started/2, logged/2.

started(Host, Option) :-
    setup_call_cleanup(host_start(Host, [Option]), true, host_stop(Host)).

logged(Options, File) :-
    with_network(ring(2), Options, Net,
        network_save(Net, File)),
    setup_call_cleanup(network_load(File, Again, []), true,
                       network_stop(Again)).

in_files(Goal, Dir) :-
    forall(file(Name, Text),
           ( directory_file_path(Dir, Name, File),
             write_file(File, Text) )),
    working_directory(Old, Dir),
    call_cleanup(Goal, working_directory(_, Old)).

file('hi.pl', ":- agent(hi, []).\non_message(_, _).\n").
file('pay.pl', ":- payload(pay, [provides([t/1])]).\nt(1).\n").
file('facts.pl', "fact(1).\n").
file('rules.pl', "refuse(halt/0).\n").

%   outcome(:Goal, -Outcome): true, false, late or error(Formal, Text).

outcome(Goal, Outcome) :-
    (   catch(call_with_time_limit(20, Goal), Ball, true)
    ->  (   var(Ball)
        ->  Outcome = true
        ;   Ball = error(Formal, _)
        ->  message_text(Ball, Text),
            Outcome = error(Formal, Text)
        ;   Outcome = Ball
        )
    ;   Outcome = false
    ).

with(Goal) :-
    with_network(edges([alpha-beta]), [clock(virtual)], Net,
        ( create([on_message(_, _)], _, [name(bob), host(alpha)]),
          forall(call(Goal, Net, Problem),
                 assertion(Problem == none)) )).

%   replaced(+Net, -Call, -I, -Name): argument I of Call is unbound. It is an
%   input of this name, or '' if it may be unbound.

replaced(Net, Call, I, Name) :-
    valid(Goal0, Inputs),
    Goal0 =.. [Functor|Args0],
    findall(Arg, ( member(Arg0, Args0),
                   ( Arg0 == net -> Arg = Net ; Arg = Arg0 ) ), Args),
    length(Args, Arity),
    functor(Call, Functor, Arity),
    between(1, Arity, I),
    forall_others(1, I, Args, Call),
    nth1(I, Args, Valid),
    (   var(Valid)
    ->  Name = ''
    ;   findall(J, ( nth1(J, Args, A), nonvar(A) ), Bound),
        nth1(K, Bound, I),
        ( nth1(K, Inputs, Name) -> true ; Name = '' )
    ).

forall_others(_, _, [], _).
forall_others(I, I, [_|Args], Call) :-
    !,
    J is I+1,
    forall_others(J, I, Args, Call).
forall_others(J, I, [Arg|Args], Call) :-
    arg(J, Call, Arg),
    K is J+1,
    forall_others(K, I, Args, Call).

unbound(Net, Problem) :-
    replaced(Net, Call, I, Name),
    Name \== '',
    functor(Call, Functor, Arity),
    \+ accepts(Functor/Arity, I, _),
    outcome(Call, Outcome),
    format(string(Begin), "~w/~w, argument ~w: ", [Functor, Arity, Name]),
    (   Outcome = error(instantiation_error, Text),
        string_concat(Begin, _, Text)
    ->  Problem = none
    ;   Problem = Functor/Arity-Name-Outcome
    ).

wrong(Net, Problem) :-
    replaced(Net, Call, I, _),
    functor(Call, Functor, Arity),
    member(Wrong, [17, 1.5, f(x), [1|_], g([])]),
    \+ accepts(Functor/Arity, I, Wrong),
    \+ \+ ( arg(I, Call, Wrong), outcome(Call, Outcome),
            nb_setval(test_outcome, Outcome) ),
    nb_getval(test_outcome, Outcome),
    (   Outcome = error(Formal, Text),
        formal_named(Formal, Functor/Arity, Text),
        one_line(Text)
    ->  Problem = none
    ;   Problem = Functor/Arity-I-Wrong-Outcome
    ).

%   Errors of types and domains name the predicate.

formal_named(Formal, PI, Text) :-
    functor(Formal, Kind, _),
    (   memberchk(Kind, [ type_error, domain_error, instantiation_error,
                          uninstantiation_error ])
    ->  format(string(Begin), "~w, argument ", [PI]),
        string_concat(Begin, _, Text)
    ;   true
    ).

one_line(Text) :-
    split_string(Text, "\n", "", [_|Lines]),
    ( Lines == [] ; Lines == [""] ),
    !,
    \+ ( member(Raw, ["Unknown error", "unexpectedly failed",
                      "Unhandled exception"]),
         sub_string(Text, _, _, _, Raw) ).

errors_typed(Queries, Errors, Dir) :-
    typed(Queries, Dir, Lines),
    findall(Line, ( member(Line, Lines),
                    sub_string(Line, _, _, _, "ERROR") ), Errors).

:- begin_tests(user_errors).

test(table_has_all_exports, Missing == []) :-
    module_property(typhon, exports(PIs)),
    findall(Name/Arity,
            ( member(Name/Arity, PIs),
              Arity > 0,
              functor(Head, Name, Arity),
              \+ valid(Head, _) ),
            Missing).
test(unbound_input_is_named) :-
    with(unbound).
test(wrong_argument_is_named) :-
    with(wrong).
test(earlier_value_of_a_variable_is_suggested,
     Lines == [ "ERROR: network_stop/1, argument Network: Arguments are not \c
                 sufficiently instantiated (its value in an earlier query is \c
                 $N)" ]) :-
    with_tmp_dir(errors_typed(['N = net.', 'network_stop(N).'], Lines)).

test(files_are_also_named_by_strings) :-
    with_hosts([alpha],
               with_tmp_dir(in_files(forall(file_call(_, Goal),
                                            assertion(Goal))))).
test(file_of_an_unknown_path_does_not_exist,
     [ forall(member(Goal-Spec, [ network_save(_, no_path(x))-no_path(x),
                                  network_load(no_path(x), _, [])-no_path(x),
                                  log_server_start([file(no_path(x))], _)
                                  -no_path(x) ])),
       error(existence_error(source_sink, Spec)) ]) :-
    (   Goal = network_save(Net, _)
    ->  with_network(ring(2), [], Net,
            Goal)
    ;   call(Goal)
    ).

:- end_tests(user_errors).
