:- module(typhon_cell_inside, []).
:- use_module(library(lists), [member/2]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).
:- use_module(library(settings), [set_setting/2]).
:- use_module(library(terms), [term_size/2]).
:- use_module('../../kernel/base/bounds', [space_used_up/1]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/base/on_demand', [on_demand_load/2]).
:- use_module('../../kernel/base/error_text', [is_tree/2]).
:- use_module('../../kernel/program',
              [ answer_at/3, code_known/2, code_receive/2, fault_noted/1,
                machine_run/3, plain_goals/2 ]).
:- use_module('../../kernel/wire', [mobile_term/1]).
:- use_module('../../kernel/host',
              [context_set/3, host/3, host_start/1]).
:- use_module('../../tools/administration', [host_change/2]).
:- use_module('../../kernel/agent',
              [ agent_add/2, agent_code/2, agent_module/5 ]).
:- use_module('../../language/faults', [printable_fallback/2]).
:- use_module('../../kernel/vocabulary', []).
:- use_module(cell_frames).

/** <module> The program of a cell

The cell runs turns of agents for the gatekeeper, see typhon_gatekeeper, on a
host of its own that has the same policy.  Calls of host predicates become
requests to the gatekeeper; all other goals run in the cell.

No other process relies on the cell: an agent that has escaped from its rules
may do whatever the operating system allows this process.

*Threading*: one thread; creating others is disabled.
*/

:- dynamic
    agent_here/2,               % Id, Module: holds the state of agent Id
    limit/2,                    % What, Most: limit of an agent
    offered/1,                  % PI: service of the place of the host
    unsent/1.                   % Goal: call without an answer, not sent yet

%   cell_main
%
%   Serve the gatekeeper until it closes the connection, and halt.

:- public cell_main/0.

cell_main :-
    set_prolog_flag(stack_limit, 268 435 456),
    set_setting(typhon_code:programs, 10 000),
    connection(In, Out),
    own_host_start,
    wrap_words,
    check_catches,
    open_null_stream(Null),
    set_stream(Null, alias(user_error)),
    cell_frame_write(Out, ready),
    serve(In, Out).

connection(In, Out) :-
    stream_property(In, alias(user_input)),
    stream_property(Out, alias(user_output)),
    set_stream(In, tty(false)),
    set_stream(Out, tty(false)),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(In, newline(posix)),
    set_stream(Out, newline(posix)),
    set_stream(Out, buffer(full)),
    nb_setval(cell_connection, connection(In, Out)),
    open_null_stream(Null),
    set_stream(Null, alias(user_output)).

%   The host is started without the option policy(_), which would load the
%   default quotas: the gatekeeper enforces quotas.

own_host_start :-
    host_start(cell),
    on_demand_load(host_option, policy),
    set_policy(guarded).

set_policy(Policy) :-
    forall(typhon_host_parts:changes(policy(Policy), cell), true),
    host_change(cell, seed(0)).         % compiles the parts of the host anew

serve(In, Out) :-
    repeat,
    cell_frame_read(In, Frame),
    (   Frame == end_of_file
    ->  halt(0)
    ;   handle(Frame, Out)
    ),
    fail.

handle(host(Rules, PIs, Limits), _) :-
    !,
    limits_put(Limits),
    (   Rules == guarded
    ->  true
    ;   rules_file('/tmp/policy', Rules),
        set_policy('/tmp/policy')
    ),
    offer(PIs).
handle(turn(N, Id, Hash, Program, State, Known, Forget, Goals), Out) :-
    forall(member(Gone, Forget), forget(Gone)),
    (   catch(agent_ready(Id, Hash, Program, State, Module), error(Formal, _),
              cell_frame_write(Out, outcome(N, raised(error(Formal, _)), none,
                                            [])))
    ->  ( var(Module) -> true ; turn(N, Id, Known, Goals, Module, Out) )
    ;   cell_frame_write(Out, lacks(N))
    ).

rules_file(File, Text) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        write(Out, Text),
        close(Out)).

                /*******************************
                *            AGENTS            *
                *******************************/

%   agent_ready(+Id, +Hash, +Program, +State, -Module) is semidet: fails if the
%   cell lacks the program or the state.

agent_ready(Id, _, known, same, Module) :-
    !,
    agent_here(Id, Module).
agent_ready(Id, Hash, Program, State, Module) :-
    State = state(_, _),
    (   Program == known
    ->  code_known(Hash, _)
    ;   code_receive(Hash, Program)
    ),
    forget(Id),
    host(cell, _, Place),
    agent_module(Id, Place, Hash, State, Module),
    state_bounded(Module),
    assertz(agent_here(Id, Module)).

forget(Id) :-
    (   retract(agent_here(Id, Module))
    ->  '$destroy_module'(Module)
    ;   true
    ).

turn(N, Id, Known, Goals, Module, Out) :-
    b_setval(cell_turn, turn(N, Known, Module)),
    context_set(cell, Id, Module),
    agent_code(Module, Program),
    state_mark(Module, Mark),
    nb_setval(cell_mark, Mark),
    monotonic_time(Now),
    nb_setval(cell_untold, told(0, Now)),
    run(context(Program, Module), Goals, Outcome, Note),
    send_all(N, 0),
    nb_getval(cell_mark, Since),
    state_changes(Module, Since, Changes),
    catch(cell_frame_write(Out, outcome(N, Outcome, Note, Changes)),
          error(resource_error(What), _),
          cell_frame_write(Out, outcome(N, raised(error(resource_error(What),
                                                        _)), none, []))).

%   An outcome that cannot travel raises an error at the control predicate, as
%   it does outside of cells.

run(Context, Goals0, Outcome, Note) :-
    machine_run(Context, Goals0, Outcome1),
    outcome_plain(Outcome1, Outcome0),
    (   Outcome0 = effect(Control, Hole, Goals),
        catch(( small_and_mobile(Outcome0), fail ), error(Formal, Where), true)
    ->  answer_at(Control, throw(error(Formal, Where)), Hole),
        run(Context, Goals, Outcome, Note)
    ;   Outcome0 = raised(Error0)
    ->  within_limits(Error0),
        printable_fallback(Error0, Error),
        Outcome = raised(Error),
        outcome_note(Outcome, Note)
    ;   Outcome = Outcome0,
        outcome_note(Outcome, Note)
    ).

outcome_plain(effect(Control, Hole, Goals0), Outcome) =>
    Outcome = effect(Control, Hole, Goals),
    plain_goals(Goals0, Goals).
outcome_plain(Outcome0, Outcome) =>
    Outcome = Outcome0.

outcome_note(Outcome, note(How, Portable)) :-
    functor(Outcome, How, _),
    memberchk(How, [failed, raised]),
    fault_noted(How-fault(Goal, Goals, natives(Raising, _))),
    !,
    printable_fallback(fault(Goal, Goals, natives(Raising, [])), Portable).
outcome_note(_, none).

                /*******************************
                *            LIMITS            *
                *******************************/

%   The gatekeeper enforces the quotas.  These limits end an agent whose turn
%   would never reach the gatekeeper, or would not fit into a frame.

limits_put(Limits) :-
    retractall(limit(_, _)),
    forall(member(What-Most, Limits), assertz(limit(What, Most))),
    (   limit(stack, Stack)
    ->  Far is integer(Stack)+16 000 000,
        set_prolog_flag(stack_limit, Far)
    ;   true
    ).

state_bounded(Module) :-
    (   limit(state, Most)
    ->  module_property(Module, program_size(Size)),
        Space is max(integer(Most), Size),
        set_module(Module:program_space(Space))
    ;   true
    ).

%   A term that shares subterms grows when it is written as text.  The limit has
%   a reserve: the gatekeeper counts only the part of the term that the quota
%   covers.

small_and_mobile(Term) :-
    (   limit(cells, Most),
        More is Most+1000,
        \+ is_tree(Term, More)
    ->  end_by(over(cells))
    ;   mobile_term(Term)
    ).

%   An agent that exceeds a limit ends, and the cell with it, before the agent
%   can catch the error: SWI-Prolog 9.0.4 crashes if its stack overflows
%   repeatedly.

check_catches :-
    wrap_predicate(typhon_checked:'$uncaught'(Ball), cell, Wrapped,
                   ( typhon_cell_inside:within_limits(Ball), Wrapped )).

:- public within_limits/1.

within_limits(Ball) :-
    (   nonvar(Ball),
        Ball = error(resource_error(What0), _),
        limit_passed(What0, How)
    ->  end_by(How)
    ;   true
    ).

%   limit_passed(+What, -How): the agent may have raised the error itself, which
%   only a state that is nearly full disproves.

limit_passed(What, ends(stack)) :-
    What == stack.
limit_passed(What, over(state)) :-
    What == program_space,
    b_getval(cell_turn, turn(_, _, Module)),
    space_used_up(Module).

end_by(How) :-
    How =.. [Name, What],
    Frame =.. [Name, N, What],
    b_getval(cell_turn, turn(N, _, _)),
    send_all(N, 0),
    nb_getval(cell_connection, connection(_, Out)),
    cell_frame_write(Out, Frame),
    halt(0).

                /*******************************
                *            WORDS             *
                *******************************/

wrap_words :-
    forall(( cell_word(_, Name/Arity),
             functor(Head, Name, Arity),
             predicate_property(typhon_vocabulary:Head, imported_from(Module))
           ),
           wrap_predicate(Module:Head, cell, _,
                          typhon_cell_inside:ask(Head))).

%   Services of the place of the host become requests in the same way.

offer(PIs) :-
    forall(( member(PI, PIs), \+ offered(PI) ), assertz(offered(PI))),
    host(cell, _, Place),
    setup_call_cleanup(
        open('/tmp/services.pl', write, Out, [encoding(utf8)]),
        forall(offered(PI), portray_service(Out, PI)),
        close(Out)),
    load_files(Place:'/tmp/services.pl', [silent(true)]).

portray_service(Out, Name/Arity) :-
    functor(Head, Name, Arity),
    numbervars(Head, 0, _),
    format(Out, ":- service(~q).~n", [Name/Arity]),
    write_term(Out, (Head :- typhon_cell_inside:ask(Head)),
               [ quoted(true), ignore_ops(true), numbervars(true),
                 fullstop(true), nl(true) ]).

:- public ask/1.

ask(Goal) :-
    b_getval(cell_turn, turn(N, Known, Module)),
    functor(Goal, Name, Arity),
    ( cell_word(Kind, Name/Arity) -> true ; Kind = acts ),
    ask(Kind, Goal, N, Known, Module).

ask(fixed, Goal, _, Known, _) :-
    !,
    memberchk(Goal, Known).
ask(tells, Goal, N, _, _) :-
    needs_no_answer(Goal),
    nb_getval(cell_untold, told(Count, Since)),
    most_unsent(_, Most),
    Count < Most,
    !,
    small_and_mobile(Goal),
    assertz(unsent(Goal)),
    Count1 is Count+1,
    nb_setval(cell_untold, told(Count1, Since)),
    send_some(N, Count1, Since).
ask(Kind, Goal, N, _, Module) :-
    small_and_mobile(Goal),
    send_all(N, 0),
    request_answer(Kind, Goal, N, Module, Answer),
    unify_answer(Answer, Goal).

%   most_unsent(-Batch, -Most): Batch calls without an answer share a frame.
%   After Most such calls the next one waits for an answer, which reports
%   errors.

most_unsent(50, 500).

%   The first call after a pause is sent at once: a long goal may follow it.

send_some(N, Count, Since) :-
    monotonic_time(Now),
    most_unsent(Batch, _),
    (   Count mod Batch =\= 0,
        Now-Since < 0.01
    ->  true
    ;   send_all(N, Count)
    ).

send_all(N, Count) :-
    findall(Goal, unsent(Goal), Goals),
    (   Goals == []
    ->  true
    ;   retractall(unsent(_)),
        nb_getval(cell_connection, connection(_, Out)),
        cell_frame_write(Out, told(N, Goals))
    ),
    monotonic_time(Now),
    nb_setval(cell_untold, told(Count, Now)).

%   A call that may raise an error which the agent could catch waits for its
%   answer.

needs_no_answer(Goal) :-
    term_size(Goal, Cells),
    Cells =< 1000,
    (   Goal = send(To, _)
    ->  atom(To)
    ;   Goal = leave(Fact)
    ->  callable(Fact)
    ;   true
    ).

request_answer(changes, Goal, N, Module, Answer) :-
    !,
    nb_getval(cell_connection, connection(In, Out)),
    nb_getval(cell_mark, Mark),
    state_changes(Module, Mark, Changes),
    cell_frame_write(Out, changing(N, Goal, Changes)),
    cell_frame_read(In, answer(N, changed(State, Answer))),
    state_put(Module, State).
request_answer(_, Goal, N, _, Answer) :-
    nb_getval(cell_connection, connection(In, Out)),
    cell_frame_write(Out, request(N, Goal)),
    cell_frame_read(In, answer(N, Answer)).

state_put(Module, state(Empty, Clauses)) :-
    forall(state_predicate(Module, Head),
           ( functor(Head, Name, Arity), abolish(Module:Name/Arity) )),
    forall(member(PI, Empty), dynamic(Module:PI)),
    agent_add(Clauses, Module),
    state_mark(Module, Mark),
    nb_setval(cell_mark, Mark).

unify_answer(solutions(Goals), Goal) :-
    (   Goals = [Only]
    ->  Goal = Only
    ;   member(Goal, Goals)
    ).
unify_answer(raised(Error), _) :-
    throw(Error).
