:- module(typhon_agent_in_journal,
          [ agent_put_down/3,           % +Id, +Status, +Goals
            agent_back/3                % +Id, +Record, +Place
          ]).
:- use_module('../base/durable_changes',
              [ durable_drop_at_once/3, durable_item/5, durable_on/0,
                durable_put/4, durable_put_at_once/4 ]).
:- use_module('../program', [code_receive/2, code_sent/2]).
:- use_module(agent_module, [agent_module/5, agent_state/2]).
:- use_module(agents, [agent/5, agent_enter/3]).
:- use_module(printable_fallback, [in_words/2]).

/** <module> Agents in the journal

What stands there of an agent is

    agent(Host, Hash, Life, State, Status, Goals)

its status being one at which it rests, or under way; its program stands
there once for all its agents.

*Threading*: inside with_agent/2 of the agent, or in the worker that has it.
*/

:- multifile
    typhon_agents:put_down/3,
    typhon_code:retiring/1.

:- dynamic code_noted/1.                % Hash

%!  agent_put_down(+Id, +Status, +Goals) is det.
%
%   Note that this is what becomes of Id, if it is one of the journal's.  One
%   that is held is there as it was before.

typhon_agents:put_down(Id, Status, Goals) :-
    agent_put_down(Id, Status, Goals).

agent_put_down(_, Status, _) :-
    ( \+ durable_on ; passing(Status) ),
    !.
agent_put_down(Id, Status, Goals) :-
    agent(Id, Host, Module, Hash, Life),
    !,
    agent_state(Module, State),
    note_code(Hash),
    note_record(Id, agent(Host, Hash, Life, State, Status, Goals)).
agent_put_down(_, _, _).

%   What cannot be written stands there in words.

note_record(Id, Record) :-
    catch(durable_put(agent, Id, 0, Record), error(_, _), fail),
    !.
note_record(Id, Record0) :-
    in_words(Record0, Record),
    print_message(warning, typhon(journal_in_words(Id))),
    durable_put(agent, Id, 0, Record).

passing(held).
passing(resumed).
passing(arriving).

%   Others see at once that it is noted: so it is, also where the unit of work
%   that brings it is not, or is committed after theirs.

note_code(Hash) :-
    code_noted(Hash),
    !.
note_code(Hash) :-
    code_sent(Hash, Sent),
    with_mutex(typhon_code_noted,
               (   code_noted(Hash)
               ->  true
               ;   durable_put_at_once(code, Hash, 0, Sent),
                   assertz(code_noted(Hash))
               )).

%   A program that has been thrown out is not needed any more.

typhon_code:retiring(Hash) :-
    code_noted(Hash),
    with_mutex(typhon_code_noted,
               ( retract(code_noted(Hash)),
                 durable_drop_at_once(code, Hash, 0) )),
    fail.

%!  agent_back(+Id, +Record, +Place) is semidet.
%
%   Id is what Record says, on its host, the place of which is Place.  It is
%   not scheduled.  Fails if its program is not to be had.
%
%   @error what agent_module/5 raises

agent_back(Id, agent(Host, Hash, Life, State, Status, Goals), Place) :-
    code_back(Hash),
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
