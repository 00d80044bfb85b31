:- module(typhon_recovery, []).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/durable',
              [durable/6, durable_kinds/2, durable_order/2, durable_restore/4]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/base/durable_changes',
              [durable_drop_all/2, durable_item/5]).
:- use_module('../../kernel/host', [host/3, host_again/1]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3]).
:- use_module('../../kernel/lifecycle', [agent_reschedule/1]).
:- use_module(journaled_agents, [agent_back/3, states_unused/1]).

/** <module> What the journal knows stands again

First everything is put where it was, while no peer is let in and no agent
runs, see typhon_durable.  Then it goes on: agents whose time has come, or that
were about to run, are scheduled, alarms are set, what was under way is asked
for or sent again.

*Threading*: the thread that starts the first host of the process.
*/

:- multifile
    typhon_code:in_use/1,
    typhon_durable:go_on/0,
    typhon_durable:recover/0,
    typhon_durable:tidy/0,
    typhon_runtime:ending/1.

:- dynamic
    superfluous/2,              % Kind, Key: no agent needs it
    left/2.                     % Id, Hash: an agent that is not back

%   last(-Kinds): they look up what others restore; mail and programs of agents
%   that are not there are superfluous.

last([agent, mail, wait, code]).

%   What this process knew before, with another journal or none, is another
%   story.

typhon_durable:recover :-
    forall(typhon_identity:ids_anew, true),
    last(Last),
    durable_kinds(Last, Kinds),
    forall(( member(Kind, Kinds),
             durable_order(Kind, Order),
             durable_item(Kind, Order, Key, N, Term) ),
           is_back(Kind, Key, N, Term)),
    forall(typhon_durable:restored, true).

%   Programs are restored with their agents.

is_back(code, Hash, _, _) :-
    !,
    (   ( agent(_, _, _, Hash, _) ; left(_, Hash) )
    ->  true
    ;   assertz(superfluous(code, Hash))
    ).
is_back(mail, Id, _, _) :-
    \+ agent(Id, _, _, _, _),
    !,
    (   left(Id, _)
    ->  true
    ;   assertz(superfluous(mail, Id))
    ).
is_back(Kind, Key, N, Term) :-
    catch(durable_restore(Kind, Key, N, Term), error(Formal, Context), true),
    !,
    (   var(Formal)
    ->  true
    ;   print_message(error, typhon(not_back(Kind, Key))),
        print_error(error, error(Formal, Context)),
        stays(Kind, Key, Term)
    ).
is_back(Kind, Key, _, Term) :-
    print_message(error, typhon(not_back(Kind, Key))),
    stays(Kind, Key, Term).

%   What stays in the journal stays there with all that belongs to it.

stays(agent, Id, agent(_, Hash, _, _, _, _)) :-
    !,
    assertz(left(Id, Hash)).
stays(_, _, _).

typhon_code:in_use(Hash) :-
    left(_, Hash),
    !.

typhon_runtime:ending(after) :-
    retractall(left(_, _)).

%   The items are made as agents come to rest, see typhon_journaled_agents.

:- durable(agent, Id, 0, Record, fail, record_back(Id, Record)).

record_back(Id, Record) :-
    Record = agent(Host, _, _, _, _, _),
    host(Host, _, Place),
    agent_back(Id, Record, Place),
    host_again(Host),
    debug(typhon(agent), '~w: is there again, on ~w', [Id, Host]).

%   Before any request can need it.

typhon_durable:tidy :-
    forall(retract(superfluous(Kind, Key)), durable_drop_all(Kind, Key)),
    states_unused(Ids),
    forall(( member(Id, Ids), \+ left(Id, _) ), durable_drop_all(state, Id)).

                /*******************************
                *            GO ON             *
                *******************************/

typhon_durable:go_on :-
    findall(Id, agent_status(Id, _, _), All),
    forall(member(Id, All), agent_reschedule(Id)).
