:- module(typhon_faulty,
          [ faulty_keep/4,              % +Id, +Goals, -Kept, -At
            faulty_stirs/1,             % +Id
            faulty_gone/1,              % +Id
            faulty_tell/3,              % +Id, +Fault, +At
            faulty_oldest/1             % -Id
          ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../host', [host/3, host_again/1, host_leave/1]).
:- use_module('../agent',
              [ agent/5, agent_ordered/1, agent_put/3, agent_ready/2,
                fault_error/2, fault_outcome/2, fault_stamp/2, is_faulty/3,
                life_hops/2 ]).
:- use_module('../travel', [agent_faulty/5]).

/** <module> Agents that are kept as they were

An agent that is faulty stands on its host with its goals, state and mail,
and does not count there.  When an order comes it stirs: it is `ready` and
counts until the order is done.  As its goals begin with its fault, see
typhon_fault, it is faulty again wherever it comes to run: after an order, a
move, or out of a restore point.  Only agent_resume/1 takes that away.

*Threading*: what takes an Id inside with_agent/2, but for faulty_tell/3.
*/


:- dynamic kept/1.                      % Id, the oldest first

%   The name under which people know it.

:- setting(typhon_creation:faulty, nonneg, 100,
           "Faulty agents kept for inspection").

%!  faulty_keep(+Id, +Goals, -Kept, -At) is semidet.
%
%   Id, which was running or obeyed an order, is faulty, as Goals say.  Kept
%   is `false` if another order has come meanwhile.  At says where it is, and
%   after how many hops: a moment later it may be elsewhere.

faulty_keep(Id, Goals, Kept, at(Host, Hops)) :-
    agent(Id, Host, _, _, Life),
    life_hops(Life, Hops),
    (   agent_ordered(Id)
    ->  agent_ready(Id, Goals),
        Kept = false
    ;   is_faulty(Goals, Fault, _),
        fault_error(Fault, Error),
        agent_put(Id, faulty(Error), Goals),
        assertz(kept(Id)),
        host_leave(Host),
        Kept = true
    ),
    !.

%!  faulty_stirs(+Id) is det.
%!  faulty_gone(+Id) is det.
%
%   Id, which is faulty, counts again on its host; or has ended.

faulty_stirs(Id) :-
    retractall(kept(Id)),
    agent(Id, Host, _, _, _),
    !,
    host_again(Host).

faulty_gone(Id) :-
    retractall(kept(Id)).

%!  faulty_tell(+Id, +Fault, +At) is det.
%
%   Let its home know.

faulty_tell(Id, Fault, at(Host, Hops)) :-
    host(Host, Address, _),
    !,
    fault_outcome(Fault, Outcome),
    fault_stamp(Fault, Stamp),
    agent_faulty(Id, Outcome, Stamp, Address, Hops).
faulty_tell(_, _, _).                   % it has gone, with its host

%!  faulty_oldest(-Id) is semidet.
%
%   There are too many: Id is the first to go.

faulty_oldest(Id) :-
    setting(typhon_creation:faulty, Max),
    predicate_property(kept(_), number_of_clauses(Count)),
    Count > Max,
    kept(Id),
    !.
