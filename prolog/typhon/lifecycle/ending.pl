:- module(typhon_ending,
          [ agent_end/2,                % +Id, +Outcome
            agent_end/3                 % +Id, :Test, +Outcome
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [nth1/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../wire', [mobile_term/1]).
:- use_module('../host', [host_leave/1, host_log/3]).
:- use_module('../agent',
              [ agent/5, agent_put/3, agent_remove/3, agent_status/3,
                life_hops/2, with_agent/2 ]).
:- use_module('../travel', [agent_ended/3, transfer_given_up/2]).

/** <module> How agents end

*Threading*: any thread.  Who removes the record of an agent, inside
with_agent/2, is the one who reports its end.
*/

:- meta_predicate agent_end(+, 1, +).

:- dynamic faulty/1.                    % Id, the oldest first

%   The name under which people know it.

:- setting(typhon_creation:faulty, nonneg, 100,
           "Faulty agents kept for inspection").

%!  agent_end(+Id, +Outcome) is semidet.
%
%   Id ends.  An agent that raised is kept as faulty(Error).

agent_end(Id, raised(Error)) :-
    !,
    with_agent(Id, make_faulty(Id, Error, Host, Hops)),
    debug(typhon(agent), '~w: is faulty, on ~w', [Id, Host]),
    host_leave(Host),
    portable(Error, Portable),
    host_log(Host, Id, faulty(Portable)),
    print_message(error, typhon(faulty(Id, Error))),
    agent_ended(Id, raised(Portable), Hops),
    forget_faulty.
agent_end(Id, Outcome) :-
    with_agent(Id, remove(Id, Last)),
    removed(Last, Id, Outcome).

%!  agent_end(+Id, :Test, +Outcome) is semidet.
%
%   Id ends if call(Test, Status) is true of it.

agent_end(Id, Test, Outcome) :-
    with_agent(Id, ( agent_status(Id, Status, _),
                     call(Test, Status),
                     remove(Id, Last)
                   )),
    removed(Last, Id, Outcome).

remove(Id, last(Host, Hops, Status)) :-
    agent(Id, Host, _, _, Life),
    life_hops(Life, Hops),
    once(agent_status(Id, Status, Goals)),
    (   Status = transit(_, _)
    ->  transfer_given_up(Id, Goals)
    ;   true
    ),
    agent_remove(Id, _, _).

removed(last(_, _, faulty(_)), Id, _) :-
    !,
    retractall(faulty(Id)).
removed(last(Host, Hops, Status), Id, Outcome) :-
    debug(typhon(agent), '~w: ends on ~w, ~p', [Id, Host, Outcome]),
    tell_of_doubt(Status, Id),
    host_leave(Host),
    host_log(Host, Id, ended(Outcome)),
    (   Outcome == failed
    ->  print_message(warning, typhon(agent_failed(Id)))
    ;   true
    ),
    agent_ended(Id, Outcome, Hops).

tell_of_doubt(transit(Address, _), Id) :-
    !,
    print_message(warning, typhon(ended_in_doubt(Id, Address))).
tell_of_doubt(_, _).

make_faulty(Id, Error, Host, Hops) :-
    agent(Id, Host, _, _, Life),
    life_hops(Life, Hops),
    agent_put(Id, faulty(Error), []),
    assertz(faulty(Id)).

portable(Error, Portable) :-
    catch(( mobile_term(Error), Portable = Error ),
          error(_, _),
          term_to_atom(Error, Portable)).

%   The oldest faulty agents go when there are too many.

forget_faulty :-
    setting(typhon_creation:faulty, Max),
    findall(Id, faulty(Id), Ids),
    length(Ids, Count),
    Excess is Count-Max,
    forall(( nth1(N, Ids, Oldest), N =< Excess ),
           ignore(agent_end(Oldest, disposed))).
