:- module(typhon_cells,
          [ cells_begin/1,              % +Host
            cells_end/1,                % +Host
            cell_take/3,                % +Key, +Agent, -Cell
            cell_wait/3,                % +Key, +Host, +Agent
            cell_give/1,                % +Cell
            cell_left/1,                % +Agent
            cell_end/2,                 % +Cell, -Reason
            cell_break/1,               % +Cell
            cell_streams/3,             % +Cell, -In, -Out
            cell_knows/3,               % +Cell, ?What, ?Value
            cell_learns/3,              % +Cell, +What, +Value
            cell_forgets/2,             % +Cell, +What
            cells_list/1                % -Cells
          ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../../kernel/base/server',
              [ server_answer/2, server_call/4, server_cast/2, server_start/4,
                server_stop/1 ]).
:- use_module('../../kernel/host', [schedule/2]).
:- use_module(cell_process,
              [cell_filter_forget/0, cell_process_end/2, cell_process_start/1]).

/** <module> The pool of cells

A cell that has run agents of one key, an atom, runs no agents of another key.
`spare` cells, which have run none, are started ahead.  A cell runs one turn at
a time; other agents of the key wait, ready but not scheduled.

The operating system kills a cell when the thread that has started it ends.  So
one server starts all cells.

*Threading*: any thread; a mutex protects the tables.  Only the thread that has
taken a cell uses its streams; it returns the cell or ends it.
*/

:- setting(cells, positive_integer, 16,
           "Processes for agents of untrusted owners, at most").
:- setting(idle, number, 60,
           "Seconds after which a cell that no agent uses ends").

:- dynamic
    server/1,                   % Server
    user/1,                     % Host: runs its agents in cells
    process/5,                  % Cell, Pid, In, Out, Err
    spare/1,                    % Cell
    bound/2,                    % Cell, Key
    idle/2,                     % Cell, Since
    waits/4,                    % Key, Number, Host, Agent: for a cell of Key
    woken/2,                    % Agent, Key: scheduled for an idle cell
    knows/3.                    % Cell, What, Value

                /*******************************
                *             HOSTS            *
                *******************************/

%!  cells_begin(+Host) is det.
%!  cells_end(+Host) is det.
%
%   Host begins to run its agents in cells; Host stops that, and its cells end.
%   The first starts a spare cell, which shows whether cells are available.
%
%   @error cell_unavailable(Cause) the machine cannot start cells

cells_begin(Host) :-
    with_mutex(typhon_cells_users, begin(Host)).

begin(Host) :-
    assertz(user(Host)),
    catch(( server_running(Server),
            server_call(Server, begin, inf, _) ), Ball,
          ( end(Host), throw(Ball) )).

cells_end(Host) :-
    with_mutex(typhon_cells_users, end(Host)).

end(Host) :-
    retractall(user(Host)),
    (   user(_)
    ->  ( server(Server) -> server_cast(Server, ended_host(Host)) ; true )
    ;   retract(server(Server))
    ->  server_stop(Server)
    ;   true
    ).

%   A bwrap is killed when its parent ends.  If it has just created the process
%   of the cell, that process waits for it for ever.  So Prolog halts when no
%   start is under way, or after ten seconds.

:- at_halt(starts_finish).

starts_finish :-
    ignore(( server(Server),
             catch(server_call(Server, finish_start, 10, _),
                   error(existence_error(server, _), _), true) )).

server_running(Server) :-
    (   server(Server)
    ->  true
    ;   server_start(cells, typhon_cells:serves, none, Server),
        assertz(server(Server))
    ).

                /*******************************
                *             TURNS            *
                *******************************/

%!  cell_take(+Key, +Agent, -Cell) is det.
%
%   Take an idle cell of Key for a turn of Agent.  Cell is `none` if all are
%   busy.

cell_take(Key, Agent, Cell) :-
    with_mutex(typhon_cells, take(Key, Agent, Cell)).

take(Key, Agent, Cell) :-
    retractall(woken(Agent, _)),
    (   bound(Cell0, Key),
        retract(idle(Cell0, _))
    ->  Cell = Cell0
    ;   Cell = none
    ).

%!  cell_wait(+Key, +Host, +Agent) is det.
%
%   Schedule Agent, which is ready, when a cell of Key is idle.

cell_wait(Key, Host, Agent) :-
    with_mutex(typhon_cells, wait(Key, Host, Agent, Next)),
    dispatch(Next).

wait(Key, Host, Agent, Next) :-
    flag(typhon_cell_waits, N, N+1),
    assertz(waits(Key, N, Host, Agent)),
    next_of(Key, Next).

%!  cell_left(+Agent) is det.
%
%   Agent has left its host.  If it was scheduled for an idle cell, the next
%   agent that waits for this cell is scheduled instead.

cell_left(Agent) :-
    (   ( waits(_, _, _, Agent) ; woken(Agent, _) )
    ->  with_mutex(typhon_cells, left(Agent, Next)),
        dispatch(Next)
    ;   true
    ).

left(Agent, Next) :-
    forall(waits(Key, N, _, Agent), retractall(waits(Key, N, _, _))),
    (   woken(Agent, Key)
    ->  retractall(woken(Agent, _)),
        next_of(Key, Next)
    ;   Next = none
    ).

%   next_of(+Key, -Next): Next is run(Host, Agent) if an idle cell of Key can
%   run a waiting agent, `wanted` if a cell must be started for Key, else
%   `none`.

next_of(Key, Next) :-
    (   bound(Cell, Key),
        idle(Cell, _),
        \+ woken(_, Key)
    ->  ( first(Key, First) -> Next = First ; Next = none )
    ;   bound(_, Key)
    ->  Next = none
    ;   waits(Key, _, _, _)
    ->  Next = wanted
    ;   Next = none
    ).

first(Key, run(Host, Agent)) :-
    waits(Key, N, Host, Agent),
    !,
    retractall(waits(Key, N, _, _)),
    assertz(woken(Agent, Key)).

%!  cell_give(+Cell) is det.

cell_give(Cell) :-
    with_mutex(typhon_cells, give(Cell, Next)),
    dispatch(Next).

give(Cell, Next) :-
    bound(Cell, Key),
    !,
    monotonic_time(Now),
    assertz(idle(Cell, Now)),
    next_of(Key, Next0),
    (   Next0 == none,
        key_without_cell(_)
    ->  Next = wanted
    ;   Next = Next0
    ).
give(_, none).

key_without_cell(Key) :-
    waits(Key, _, _, _),
    \+ bound(_, Key),
    !.

dispatch(none).
dispatch(run(Host, Agent)) :-
    schedule(Host, Agent).
dispatch(wanted) :-
    (   server(Server),
        server_cast(Server, wanted)
    ->  true
    ;   true                            % the host stops
    ).

%!  cell_end(+Cell, -Reason) is det.
%!  cell_break(+Cell) is det.
%
%   End Cell, which the caller has taken and which may have ended already.
%   Reason is exit(Status) or killed(Signal).  cell_break/1 does not wait for
%   the end.

cell_end(Cell, Reason) :-
    end_process(Cell, Reason),
    dispatch(wanted).

end_process(Cell, Reason) :-
    (   with_mutex(typhon_cells, forget_cell(Cell, Process))
    ->  cell_process_end(Process, Reason)
    ;   Reason = exit(unknown)
    ).

cell_break(Cell) :-
    (   with_mutex(typhon_cells, forget_cell(Cell, Process)),
        server(Server),
        server_cast(Server, ended(Process))
    ->  true
    ;   true
    ).

forget_cell(Cell, process(Pid, In, Out, Err)) :-
    retract(process(Cell, Pid, In, Out, Err)),
    retractall(spare(Cell)),
    retractall(bound(Cell, _)),
    retractall(idle(Cell, _)),
    retractall(knows(Cell, _, _)).

%!  cell_streams(+Cell, -In, -Out) is semidet.
%
%   Fails if Cell has ended.

cell_streams(Cell, In, Out) :-
    process(Cell, _, In, Out, _),
    !.

%!  cell_knows(+Cell, ?What, ?Value) is nondet.
%!  cell_learns(+Cell, +What, +Value) is det.
%!  cell_forgets(+Cell, +What) is det.
%
%   Remember what the gatekeeper has sent to Cell, to send it once.  What is an
%   atom.

cell_knows(Cell, What, Value) :-
    knows(Cell, What, Value).

cell_learns(Cell, What, Value) :-
    retractall(knows(Cell, What, _)),
    (   process(Cell, _, _, _, _)
    ->  assertz(knows(Cell, What, Value))
    ;   true
    ).

cell_forgets(Cell, What) :-
    retractall(knows(Cell, What, _)).

%!  cells_list(-Cells) is det.
%
%   Cells are cell(Cell, Pid, Key).  Key is `spare` for a cell without a key.

cells_list(Cells) :-
    findall(cell(Cell, Pid, Key),
            ( process(Cell, Pid, _, _, _),
              ( bound(Cell, Key0) -> Key = Key0 ; Key = spare ) ),
            Cells).

                /*******************************
                *            SERVER            *
                *******************************/

:- public serves/3.

serves(call(begin, Caller), _, Next) :-
    ( spare(_) -> true ; spare_start ),
    server_answer(Caller, true),
    set_timer(Next).
serves(call(finish_start, Caller), _, Next) :-
    server_answer(Caller, true),
    set_timer(Next).
serves(wanted, _, Next) :-
    catch(provide, error(Formal, _),
          print_message(error, error(Formal, _))),
    set_timer(Next).
serves(ended(Process), _, Next) :-
    cell_process_end(Process, _),
    serves(wanted, none, Next).
serves(ended_host(Host), _, Next) :-
    atom_concat(Host, ' ', Prefix),
    forall(( bound(Cell, Key),
             once(( Key == Host ; sub_atom(Key, 0, _, _, Prefix) )) ),
           end_process(Cell, _)),
    set_timer(Next).
serves(timeout, _, Next) :-
    forall(idle_long(Cell), end_idle(Cell)),
    serves(wanted, none, Next).
serves(stop, _, _) :-
    forall(process(Cell, _, _, _, _), end_process(Cell, _)),
    retractall(waits(_, _, _, _)),
    retractall(woken(_, _)),
    cell_filter_forget.

%   The server retries once a second while agents wait for a missing cell.

set_timer(until(Stamp, none)) :-
    (   key_without_cell(_)
    ->  Seconds = 1
    ;   bound(_, _)
    ->  setting(idle, Idle),
        Seconds is Idle/4
    ;   Seconds = inf
    ),
    deadline(Seconds, Stamp).

%   provide: give a cell to each key whose agents have none, within the limit of
%   processes; then start a spare cell.

provide :-
    (   with_mutex(typhon_cells, bind_spare(Next))
    ->  dispatch(Next),
        provide
    ;   key_without_cell(_),
        room
    ->  spare_start,
        provide
    ;   \+ spare(_),
        below_most
    ->  spare_start
    ;   true
    ).

bind_spare(Next) :-
    key_without_cell(Key),
    retract(spare(Cell)),
    !,
    assertz(bound(Cell, Key)),
    give(Cell, Next).

%   room is semidet: one more process may be started.  At the limit, the cell
%   that is idle longest ends.

room :-
    (   below_most
    ->  true
    ;   oldest_idle(Cell)
    ->  end_idle(Cell)
    ).

below_most :-
    predicate_property(process(_, _, _, _, _), number_of_clauses(Count)),
    setting(cells, Most),
    Count < Most.

%   A cell for which an agent is scheduled is about to be used.

oldest_idle(Cell) :-
    findall(Since-Cell0,
            ( idle(Cell0, Since),
              \+ ( bound(Cell0, Key), woken(_, Key) ) ),
            Pairs0),
    keysort(Pairs0, [_-Cell|_]).

idle_long(Cell) :-
    setting(idle, Idle),
    monotonic_time(Now),
    idle(Cell, Since),
    Now-Since > Idle.

end_idle(Cell) :-
    (   with_mutex(typhon_cells, ( retract(idle(Cell, _)),
                                   forget_cell(Cell, Process) ))
    ->  cell_process_end(Process, _)
    ;   true                            % taken meanwhile
    ).

%   @error cell_unavailable(Cause)

spare_start :-
    cell_process_start(process(Pid, In, Out, Err)),
    flag(typhon_cell, Cell, Cell+1),
    with_mutex(typhon_cells,
               ( assertz(process(Cell, Pid, In, Out, Err)),
                 assertz(spare(Cell)) )).
