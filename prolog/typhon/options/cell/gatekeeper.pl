:- module(typhon_gatekeeper, []).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [append/2, member/2, reverse/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../kernel/base/durable', [durable_on/0]).
:- use_module('../../kernel/base/reports', [report/4]).
:- use_module('../../kernel/program',
              [code_sent/2, fault_note/1, plain_goals/2]).
:- use_module('../../kernel/host',
              [context_now/2, host/3, place_service/2, security_event/2]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_home/2, agent_origin/5, agent_put/3,
                agent_state/2, agent_variant/2, life_hops/2, life_parent/2,
                origin_key/2, with_agent/2 ]).
:- use_module('../../kernel/lifecycle', [turn_settled/0]).
:- use_module(cell_acts,
              [ cell_answer/5, cell_changes_made/3, cell_fault/3,
                cell_outcome/1, cell_stop/4, cell_turn_begins/0,
                cell_violation/1 ]).
:- use_module(cell_frames).
:- use_module(cell_functors, [functors_charged/3, functors_left/1]).
:- use_module(cell_hosts, [walled/2]).
:- use_module(cells,
              [ cell_break/1, cell_end/2, cell_forgets/2, cell_give/1,
                cell_knows/3, cell_learns/3, cell_left/1, cell_streams/3,
                cell_take/3, cell_wait/3 ]).

/** <module> Turns of agents in cells

With the option cell(Kind) each run of the machine for an agent of the host is a
turn in a cell.  Kind `owner` gives each owner of agents cells of its own, see
typhon_birth; with `host` all agents of the host share cells.  The record of the
agent, its mail, home, and state stay in this process, so the rest of the
platform does not know of cells.  Calls of host predicates in a turn become
requests of the cell.  The gatekeeper carries them out for the agent whose turn
it is: a cell cannot name another agent.  The turn returns an outcome and the
changes of the state.

If the cell dies in a turn the agent ends with lost(cell(Reason)).  With a
journal the turn is repeated once in another cell, from its beginning, if it has
changed nothing outside the cell.  So that this holds more often, calls without
an answer are carried out when the turn ends or needs an answer.

This process never calls a clause or goal of the agent.  Messages of a cell are
checked like an agent that arrives.  A cell that sends anything else ends, and
with it the agent.

*Threading*: in the worker that runs the turn.  Interrupting the worker ends the
cell, too.
*/

:- multifile
    typhon_host_parts:part/4,
    typhon_host_parts:limit/3,
    typhon_machine:elsewhere/3,
    prolog:message//1.

:- dynamic repeated/1.           % Id: its turn is being repeated

typhon_host_parts:part(goes, Host, 10, typhon_gatekeeper:goes) :-
    walled(Host, _).

:- public goes/3.

goes(Id, _, _) :-
    forall(( cell_knows(Cell, Id, What), What \== gone ),
           cell_learns(Cell, Id, gone)),
    retractall(repeated(Id)),
    cell_left(Id).

                /*******************************
                *             TURNS            *
                *******************************/

%   An agent keeps the policy under which it arrived when its host changes its
%   own. An agent that has been ended meanwhile has no record and must not run.

typhon_machine:elsewhere(context(_, Module), Goals0, Outcome) :-
    walled(_, _),
    context_now(Host, Id),
    walled(Host, Kind),
    !,
    plain_goals(Goals0, Goals),
    policy(Module, Policy),
    (   agent(Id, Host, Module, Hash, Life)
    ->  Policy \== trusted,
        run(Kind, Policy, agent(Id, Host, Module, Hash, Life), Goals, Outcome)
    ;   Outcome = held
    ).

policy(Module, Policy) :-
    (   agent_variant(Module, guarded(Policy0))
    ->  Policy = Policy0
    ;   Policy = trusted
    ).

%   When the worker is interrupted before the turn is finished the cell ends, as
%   it may be in the middle of a goal.

run(Kind, Policy, Agent, Goals, Outcome) :-
    Agent = agent(Id, _, _, _, _),
    owner(Agent, Owner),
    (   functors_left(Owner)
    ->  key(Kind, Policy, Agent, Owner, Key),
        State = state(unfinished),
        setup_call_cleanup(
            cell_take(Key, Id, Cell),
            run_in(Cell, keys(Key, Policy, Owner), Agent, Goals, State,
                   Outcome),
            break_unfinished(State, Cell))
    ;   Reason = violation(functors),
        Outcome = lost(cell(Reason)),
        ended(Agent, Reason, Outcome)
    ),
    !.
run(_, _, agent(Id, _, _, _, _), _, _) :-
    throw(error(system_error(no_turn(Id)), _)).

run_in(none, keys(Key, _, _), Agent, Goals, _, held) :-
    !,
    sig_atomic(wait_for_cell(Key, Agent, Goals)).
run_in(Cell, keys(Key, Policy, Owner), Agent, Goals, State, Outcome) :-
    run_turn(Cell, Policy, Owner-Agent, Goals, Result),
    sig_atomic(( finish_turn(Result, Cell, Agent, Outcome0),
                 nb_setarg(1, State, finished),
                 (   Outcome0 == again
                 ->  wait_for_cell(Key, Agent, Goals),
                     Outcome = held
                 ;   Outcome = Outcome0
                 ) )).

wait_for_cell(Key, agent(Id, Host, _, _, _), Goals) :-
    with_agent(Id, agent_put(Id, ready, Goals)),
    turn_settled,
    cell_wait(Key, Host, Id).

break_unfinished(state(unfinished), Cell) :-
    integer(Cell),
    !,
    cell_break(Cell).
break_unfinished(_, _).

owner(agent(Id, Host, Module, Hash, _), Owner) :-
    agent_origin(Host, Id, Hash, module(Module), Origin),
    origin_key(Origin, Owner).

key(host, Policy, agent(_, Host, _, _, _), _, Key) :-
    atomic_list_concat([Host, Policy], ' ', Key).
key(owner, Policy, agent(_, Host, _, _, _), Owner, Key) :-
    atomic_list_concat([Host, Policy, Owner], ' ', Key).

finish_turn(outcome(Outcome, Note), Cell, agent(Id, _, _, _, _), Outcome) :-
    cell_give(Cell),
    retractall(repeated(Id)),
    fault_note(Note).
finish_turn(over(What), Cell, _, over(What)) :-
    cell_end(Cell, _).
finish_turn(ends(What), Cell, _, ends(What)) :-
    cell_end(Cell, _).
finish_turn(broken(Why), Cell, Agent, Outcome) :-
    cell_end(Cell, Status),
    ( Why = ended(_) -> Reason = Status ; Reason = Why ),
    Agent = agent(Id, _, _, _, _),
    (   Why == ended(nothing),
        durable_on,
        \+ repeated(Id)
    ->  assertz(repeated(Id)),
        Outcome = again
    ;   Outcome = lost(cell(Reason))
    ),
    ended(Agent, Reason, Outcome).

ended(agent(Id, Host, _, _, _), Reason, Outcome) :-
    security_event(Host, cell(Id, Reason)),
    report(warning, ended_cells, Id,
           typhon(cell_ended(Id, Host, Reason, Outcome))).

%   run_turn(+Cell, +Policy, +OwnerAndAgent, +Goals, -Result): Result is
%   outcome(Outcome, Note), over(What), ends(What) or broken(Why).

run_turn(Cell, Policy, Owner-Agent, Goals, Result) :-
    flag(typhon_cell_turn, N, N+1),
    cell_turn_begins,
    catch(( begin_turn(Cell, Policy, Agent, N, Goals),
            read_turn(Cell, N-Owner, Agent, Goals,
                      acts(well, [], nothing), Result) ),
          error(Formal, Context),
          broken(Formal, Context, Result)).

%   Writing to a cell that has died raises an io_error.  It is ignored here:
%   reading from the cell then yields end_of_file, after the frames it sent
%   before.

begin_turn(Cell, Policy, Agent, N, Goals) :-
    catch(( bind_cell(Cell, Policy, Agent),
            send_turn(Cell, N, Agent, Goals, new) ),
          error(io_error(_, _), _),
          true).

broken(io_error(_, _), _, broken(ended(something))) :-
    !.
broken(cell_violation(What), _, broken(violation(What))) :-
    !.
broken(syntax_error(What), _, broken(violation(syntax_error(What)))) :-
    !.
broken(resource_error(c_stack), _, broken(violation(too_deep))) :-
    !.
broken(Formal, Context, _) :-
    throw(error(Formal, Context)).

%   The first turn binds the cell to the host.  Later changes of the services or
%   of the limits are sent with the next turn.

bind_cell(Cell, Policy, agent(_, Host, _, _, _)) :-
    host(Host, _, Place),
    findall(PI, place_service(Place, PI), PIs),
    findall(What-Most, typhon_host_parts:limit(Host, What, Most), Limits),
    (   cell_knows(Cell, host, PIs-Limits)
    ->  true
    ;   rules(Policy, Rules),
        send(Cell, host(Rules, PIs, Limits)),
        cell_learns(Cell, host, PIs-Limits)
    ).

rules(Policy, Rules) :-
    (   Policy == guarded
    ->  Rules = guarded
    ;   read_file_to_string(Policy, Rules, [encoding(utf8)])
    ).

send(Cell, Frame) :-
    cell_streams(Cell, _, Out),
    cell_frame_write(Out, Frame).

%   send_turn(+Cell, +N, +Agent, +Goals, +How): How is `again` if the cell has
%   answered that it lacks the program or the state, else `new`.

send_turn(Cell, N, agent(Id, Host, Module, Hash, Life), Goals, How) :-
    ( How == again -> cell_forgets(Cell, Id), cell_forgets(Cell, Hash) ; true ),
    program_for(Cell, Hash, Program),
    state_for(Cell, Id, Module, State),
    turn_facts(Id, Host, Life, Known),
    findall(Gone, cell_knows(Cell, Gone, gone), Forget),
    forall(member(Gone, Forget), cell_forgets(Cell, Gone)),
    send(Cell, turn(N, Id, Hash, Program, State, Known, Forget, Goals)),
    cell_learns(Cell, Hash, sent).

program_for(Cell, Hash, known) :-
    cell_knows(Cell, Hash, sent),
    !.
program_for(_, Hash, Program) :-
    code_sent(Hash, Program).

state_for(Cell, Id, Module, same) :-
    cell_knows(Cell, Id, Module-Mark),
    state_mark(Module, Mark),
    !.
state_for(_, _, Module, State) :-
    agent_state(Module, State0),
    cell_state(State0, State).

turn_facts(Id, Host, Life, Known) :-
    host(Host, Address, _),
    agent_home(Id, Home),
    life_hops(Life, Hops),
    life_parent(Life, Parent),
    ( Parent == none -> Last = [] ; Last = [parent(Parent)] ),
    Known = [self(Id), here(Address), home(Home), hops(Hops)|Last].

                /*******************************
                *       FRAMES OF A CELL       *
                *******************************/

%   read_turn(+Cell, +NAndOwner, +Agent, +Goals, +Acts, -Result): Acts is
%   acts(Told, Later, Done).  Told is raised(Error) if a call without an answer
%   has raised Error, else `well`.  Later are lists of such calls that are not
%   carried out yet, the last list first.  Done is `something` if the turn may
%   have changed the host, else `nothing`.

read_turn(Cell, N-Owner, Agent, Goals, Acts, Result) :-
    cell_streams(Cell, In, _),
    read_frame(In, Owner, Frame),
    (   is_of_turn(Frame, N),
        handle_frame(Frame, Cell, Agent, Goals, Acts, Next)
    ->  (   Next = more(Acts1)
        ->  read_turn(Cell, N-Owner, Agent, Goals, Acts1, Result)
        ;   Result = Next
        )
    ;   cell_violation(frame)
    ).

read_frame(In, Owner, Frame) :-
    (   cell_frame_text(In, Text)
    ->  functors_charged(Owner, Text, Frame)
    ;   Frame = end_of_file
    ).

is_of_turn(Frame, _) :-
    Frame == end_of_file,
    !.
is_of_turn(Frame, N) :-
    compound(Frame),
    arg(1, Frame, N0),
    N0 == N.

handle_frame(end_of_file, _, _, _, acts(_, _, Done), broken(ended(Done))).
handle_frame(told(_, Words), _, Agent, _, acts(Told0, Later, Done),
             more(Acts)) :-
    is_list(Words),
    Acts0 = acts(Told0, [Words|Later], Done),
    (   durable_on
    ->  Acts = Acts0
    ;   carry_out(Acts0, Agent, Told),
        Acts = acts(Told, [], something)
    ).
handle_frame(request(N, Goal), Cell, Agent, _, Acts,
             more(acts(well, [], Done))) :-
    carry_out(Acts, Agent, Told),
    answer_goal(Told, Goal, acts, Agent, Answer),
    done(Acts, Goal, Done),
    send(Cell, answer(N, Answer)).
handle_frame(changing(N, Goal, Changes), Cell, Agent, _, Acts, more(Next)) :-
    Next = acts(well, [], something),
    carry_out(Acts, Agent, Told),
    Agent = agent(_, Host, Module, _, _),
    cell_changes_made(Changes, Host, Module),
    answer_goal(Told, Goal, changes, Agent, Answer),
    agent_state(Module, State0),
    cell_state(State0, State),
    send(Cell, answer(N, changed(State, Answer))).
handle_frame(lacks(N), Cell, Agent, Goals, Acts, more(Acts)) :-
    Acts = acts(well, [], _),
    \+ cell_knows(Cell, again, N),
    cell_learns(Cell, again, N),
    send_turn(Cell, N, Agent, Goals, again).
handle_frame(over(_, What), _, Agent, _, Acts, over(What)) :-
    nonvar(What),
    memberchk(What, [cells,stack,state]),
    carry_out(Acts, Agent, _).
handle_frame(ends(_, What), _, Agent, _, Acts, ends(stack)) :-
    What == stack,
    carry_out(Acts, Agent, _).
handle_frame(outcome(_, Outcome, Note, Changes), Cell, Agent, _, Acts,
             Result) :-
    cell_outcome(Outcome),
    cell_fault(Note, Outcome, Fault0),
    carry_out(Acts, Agent, Told),
    Agent = agent(Id, Host, Module, _, _),
    (   Told == well
    ->  cell_stop(Outcome, Host, Agent, Result1)
    ;   Result1 = Told
    ),
    ( Result1 == Outcome -> Fault = Fault0 ; Fault = none ),
    Result = outcome(Result1, Fault),
    cell_changes_made(Changes, Host, Module),
    (   Outcome = raised(_)             % the cell may have sent no changes
    ->  cell_forgets(Cell, Id)
    ;   state_mark(Module, Mark),
        cell_learns(Cell, Id, Module-Mark)
    ).

carry_out(acts(Told0, Later, _), Agent, Told) :-
    reverse(Later, Lists),
    append(Lists, Words),
    foldl(run_word(Agent), Words, Told0, Told).

run_word(Agent, Goal, Told0, Told) :-
    answer_goal(Told0, Goal, tells, Agent, Answer),
    ( Answer = raised(_) -> Told = Answer ; Told = well ).

done(acts(_, [], Done), Goal, Done) :-
    functor(Goal, Name, Arity),
    cell_word(looks, Name/Arity),
    !.
done(_, _, something).

%   After an error no further call is carried out until the agent has received
%   that error.

answer_goal(well, Goal, Kind, Agent, Answer) :-
    Agent = agent(_, Host, _, _, _),
    cell_answer(Goal, Kind, Host, Agent, Answer).
answer_goal(raised(Error), _, _, _, raised(Error)).

prolog:message(typhon(cell_ended(Id, Host, Reason, Outcome))) -->
    [ 'Agent ~w on ~w '-[Id, Host] ],
    ( { Outcome == again } -> [ 'runs again in another cell' ] ; [ 'is lost' ] ),
    [ ': its cell ended, ~p'-[Reason] ].
