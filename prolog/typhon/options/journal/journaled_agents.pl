:- module(typhon_journaled_agents,
          [ agent_back/3,               % +Id, +Record, +Place
            states_unused/1             % -Ids
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(terms), [term_size/2]).
:- use_module('../../kernel/base/durable',
              [ durable/5, durable_drop_all/2, durable_item/5, durable_on/0,
                enqueue_changes/0, unit_of_work/1 ]).
:- use_module('../../kernel/program', [code_receive/2, code_sent/2]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_enter/3, agent_module/5, agent_note/3,
                agent_state/2 ]).
:- use_module('../../language/faults', [printable_fallback/2]).
:- use_module(units_of_work,
              [ changes_add/1, changes_bytes/2, changes_drop_at_once/3,
                changes_put_at_once/4, changes_putting/5, deferred_any/0,
                deferred_commit/0, deferred_release/0 ]).
:- use_module(state_log,
              [ state_log_begin/1, state_log_changes/2, state_log_end/1,
                state_replayed/3 ]).

/** <module> Agents in the journal

The item of an agent is

    agent(Host, Hash, Life, State, Status, Goals)

where Status is a status in which the agent rests, or in transit.  All agents of
a program share one item that holds it.

A small state is a part of this item.  For a large state the item holds `log`,
and the state is in the items state(Id, N): the whole state for N=0, and lists
of changes, see typhon_state_log, for N=1, 2 and so on.  When the changes have
become as long as the state, the whole state replaces them all.

A turn is one unit of work: the effects of the agent are recorded together with
its next goals, and released after that.  As soon as the agent rests another
worker may run it, and its messages from then on must not overtake the earlier
ones.

*Threading*: inside with_agent/2 of the agent, or in the worker that has it.
*/

:- multifile
    typhon_agents:put_down/3,
    typhon_agents:state_ends/2,
    typhon_code:retiring/1,
    typhon_units_of_work:dropped/1,
    typhon_runtime:ending/1,
    typhon_turn:settle/0,
    typhon_turn:unit/2.

:- dynamic
    code_noted/1,               % Hash
    logged/5,                   % Id, Module, N: number of the next changes,
                                % Bytes of the state, and of the changes; the
                                % module is `none` if the whole state must be
                                % recorded next
    stored/3.                   % Id, N, Item: part of the state of an agent
                                % that is not restored yet

%   A state with more cells has a log.  So many cells take about 4 kB.

large(2000).

%   Changes are kept until they are longer than the state, and than this.

most_changes(65536).

                /*******************************
                *             TURNS            *
                *******************************/

typhon_turn:unit(typhon_units_of_work:defer_effects,
                 typhon_journaled_agents:conclude) :-
    durable_on.

typhon_turn:settle :-
    unit_of_work(deferred_commit),
    deferred_release.

:- public conclude/4.

conclude(Id, Outcome, Conclude, Next) :-
    unit_of_work(( turn_ends(Outcome, Id),
                   call(Conclude),
                   note_next(Next, Id) )),
    deferred_release.

turn_ends(effect(Control, Hole, Goals), Id) :-
    !,
    \+ \+ ( Hole = Control,
            record_before_rest(Id, Goals) ).
turn_ends(done, Id) :-
    !,
    record_before_rest(Id, []).
turn_ends(_, _) :-
    deferred_commit.

record_before_rest(Id, Goals) :-
    (   deferred_any
    ->  deferred_commit,
        agent_note(Id, ready, Goals),
        enqueue_changes,
        deferred_release
    ;   true
    ).

note_next(stop, _).
note_next(go(Goals), Id) :-
    agent_note(Id, ready, Goals).
note_next(elsewhere(_, _, Goals), Id) :-
    agent_note(Id, ready, Goals).

                /*******************************
                *            RECORDS           *
                *******************************/

%   A transient status is not recorded: the journal keeps the previous record of
%   the agent.

typhon_agents:put_down(Id, Status, Goals) :-
    \+ is_transient(Status),
    agent(Id, Host, Module, Hash, Life),
    !,
    note_code(Hash),
    note_state(Id, Module, State),
    note_item(Id, agent, 0, agent(Host, Hash, Life, State, Status, Goals), _).

is_transient(held).
is_transient(resumed).
is_transient(arriving).

%   note_state(+Id, +Module, -State): State is the part of the agent's item that
%   holds its state.

note_state(Id, Module, State) :-
    logged(Id, Module, N, Whole, Bytes),
    state_log_changes(Module, Changes),
    !,
    State = log,
    note_changes(Changes, Id, Module, N, Whole, Bytes).
note_state(Id, Module, State) :-
    agent_state(Module, State0),
    term_size(State0, Cells),
    large(Most),
    (   Cells > Most
    ->  State = log,
        note_whole(Id, Module, State0)
    ;   State = State0,
        unlog(Id)
    ).

note_changes([], _, _, _, _, _) :-
    !.
note_changes(Changes, Id, Module, N, Whole, Bytes0) :-
    note_item(Id, state, N, Changes, Count),
    Bytes is Bytes0+Count,
    most_changes(Most),
    (   Bytes > max(Whole, Most)
    ->  agent_state(Module, State),
        note_whole(Id, Module, State)
    ;   N1 is N+1,
        put_logged(Id, Module, N1, Whole, Bytes)
    ).

note_whole(Id, Module, State) :-
    state_log_begin(Module),
    durable_drop_all(state, Id),
    note_item(Id, state, 0, State, Count),
    put_logged(Id, Module, 1, Count, 0).

put_logged(Id, Module, N, Whole, Bytes) :-
    retractall(logged(Id, _, _, _, _)),
    assertz(logged(Id, Module, N, Whole, Bytes)).

unlog(Id) :-
    (   logged(Id, Module, _, _, _)
    ->  retractall(logged(Id, _, _, _, _)),
        durable_drop_all(state, Id),
        state_log_end(Module)
    ;   true
    ).

%   A term that cannot be written in binary form is recorded as text.

note_item(Id, Kind, N, Term, Count) :-
    catch(changes_putting(Kind, Id, N, Term, Change), error(_, _), fail),
    !,
    changes_bytes(Change, Count),
    changes_add(Change).
note_item(Id, Kind, N, Term0, Count) :-
    printable_fallback(Term0, Term),
    print_message(warning, typhon(journal_in_words(Id))),
    changes_putting(Kind, Id, N, Term, Change),
    changes_bytes(Change, Count),
    changes_add(Change).

%   The module is about to be destroyed: the agent has ended, or uses another
%   one.

typhon_agents:state_ends(Id, Module) :-
    logged(Id, Module, _, _, _),
    !,
    retractall(logged(Id, _, _, _, _)),
    state_log_end(Module),
    (   agent(Id, _, _, _, _)
    ->  put_logged(Id, none, 0, 0, 0)
    ;   durable_drop_all(state, Id)
    ).

%   These Changes were taken from the log and not recorded, so the log is
%   incomplete: record the whole state with the next item of the agent.

typhon_units_of_work:dropped(Changes) :-
    forall(member(put(state, Id, _, _), Changes),
           put_logged(Id, none, 0, 0, 0)).

typhon_runtime:ending(after) :-
    findall(Module, logged(_, Module, _, _, _), Modules),
    retractall(logged(_, _, _, _, _)),
    maplist(state_log_end, Modules),
    retractall(stored(_, _, _)).

%   Record the program outside the present unit of work: other threads rely on
%   the code_noted/1 fact at once, and the present unit may fail, or be
%   committed after theirs.

note_code(Hash) :-
    code_noted(Hash),
    !.
note_code(Hash) :-
    code_sent(Hash, Sent),
    with_mutex(typhon_code_noted,
               (   code_noted(Hash)
               ->  true
               ;   changes_put_at_once(code, Hash, 0, Sent),
                   assertz(code_noted(Hash))
               )).

%   The journal does not need a program that was discarded.

typhon_code:retiring(Hash) :-
    code_noted(Hash),
    with_mutex(typhon_code_noted,
               ( retract(code_noted(Hash)),
                 changes_drop_at_once(code, Hash, 0) )),
    fail.

                /*******************************
                *           RESTORE            *
                *******************************/

%!  agent_back(+Id, +Record, +Place) is semidet.
%
%   Restore the agent Id from Record on its host, whose place is Place.  It is
%   not scheduled.  Fails if its program is missing.
%
%   @error the errors of agent_module/5 and state_replayed/3

agent_back(Id, agent(Host, Hash, Life, Noted, Status, Goals), Place) :-
    code_back(Hash),
    state_back(Noted, Id, State),
    agent_module(Id, Place, Hash, State, Module),
    agent_enter(agent(Id, Host, Module, Hash, Life), Status, Goals).

code_back(Hash) :-
    code_noted(Hash),
    !.
code_back(Hash) :-
    durable_item(code, any, Hash, _, Sent),
    code_receive(Hash, Sent),
    assertz(code_noted(Hash)),
    !.

:- durable(state, Id, N, Item, stored(Id, N, Item)).

%   The facts stored/3 are in the order of their numbers.

state_back(log, Id, State) =>
    findall(Changes, ( stored(Id, N, Changes), N > 0 ), All),
    stored(Id, 0, Whole),
    !,
    state_replayed(Whole, All, State),
    retractall(stored(Id, _, _)),
    put_logged(Id, none, 0, 0, 0).
state_back(State0, _, State) =>
    State = State0.

%!  states_unused(-Ids:list) is det.
%
%   The journal has states of Ids that no restored agent has used.

states_unused(Ids) :-
    findall(Id, stored(Id, _, _), All),
    sort(All, Ids),
    retractall(stored(_, _, _)).
