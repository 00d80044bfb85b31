:- module(typhon_within,
          [ hop_at_once/6,              % +Id, +Here, +Name, +Hole, +Goals,
                                        % -Next
            hop_within/6                % +Id, +Name, +Hole, +Goals, +Since,
                                        % -Next
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../wire', [endpoint_address/1, mobile_term/1]).
:- use_module('../host',
              [ address_parts/3, event/4, event_subscribed/1, host/3,
                host_hop/3, host_leave/1, host_passes/4, host_plain/2,
                host_time/2, schedule/2, schedule_stays/2, time_now/1 ]).
:- use_module('../agent',
              [ agent/5, agent_links/4, agent_mobile/6, agent_move/5,
                agent_passes/6, agent_put/3, agent_relink/2, agent_runs/1,
                agent_build/5, agent_state/2, agent_state_mobile/3,
                agent_status/3, gate/4, life_goes/3, life_hop/3,
                with_agent/2 ]).
:- use_module(transfer, [move_over/2]).
:- use_module(whereabouts, [agent_seen/4]).

/** <module> Hops between hosts of one process

No image is sent, and no transfer can be in doubt: the record of the agent
changes in one step.  Its mail and orders stay where they are, and mostly its
state does, too.  To the agent the hop is like any other: its terms must be
mobile, and its place changes.  Only the bound on the length of a frame does not
apply.

*Threading*: in a worker, which has the agent.
*/

%!  hop_at_once(+Id, +Here, +Name, +Hole, +Goals, -Next) is semidet.
%
%   As hop_within/6, between plain hosts, for an agent that moves from Here, may
%   move and carries no extras, if hops are not delayed and have no listener.
%   In all other cases it fails without changes.

hop_at_once(Id, Here, Name, Hole, Goals, Next) :-
    host_plain(Here, From),
    From = plain(_, _, none, Epoch, Rate, _, _, _, _),
    host_plain(Name, To),
    \+ event_subscribed(hops),
    agent_mobile(Id, Here, Module, Hash, Life0, Until0),
    life_goes(Life0, Life, Hops),
    !,
    time_now(Now),
    Since is (Now-Epoch)*Rate,
    agent_state_mobile(Module, Until0, Until),
    mobile_term(Life-Goals),
    Going = going(Module, Hash, Life, Until, Since),
    sig_atomic(passed(Id, Here-From, Name-To, Going, Hole-Goals, Hops, Next)).

%!  hop_within(+Id, +Name, +Hole, +Goals, +Since, -Next) is det.
%
%   Id, which departed at Since, is on host Name of this process, with Goals,
%   its Hole bound to `true`; or it was ended meanwhile.  Next is `stop`, or
%   elsewhere(Goals) if it keeps its worker.
%
%   @error type_error(mobile_term, Culprit)
%   @error move_refused(Address, Reason)

hop_within(Id, Name, Hole, Goals, Since, Next) :-
    agent_mobile(Id, Here, Module, Hash, Life0, Until0),
    !,
    life_hop(Life0, Life, Hops),
    agent_state_mobile(Module, Until0, Until),  % only what has changed
    mobile_term(Life-Goals),
    Going = going(Module, Hash, Life, Until, Since),
    (   host_plain(Here, From),
        host_plain(Name, To),
        sig_atomic(passed(Id, Here-From, Name-To, Going, Hole-Goals, Hops,
                          Next0))
    ->  Next = Next0
    ;   gate(Name, going-entrant(Id, Hash, Life, module(Module), []),
             moved(Id, Here-Name, Going, Hole-Goals, Hops, Next),
             Verdict),
        conclude(Verdict, Id, Here-Name, Hops, Next)
    ).
hop_within(_, _, _, _, _, stop).        % it was ended

%   passed(+Id, +From, +To, +Going, +Held, +Hops, -Next) is semidet: for plain
%   hosts, and if there is capacity.  In all other cases it fails without
%   changes.

passed(Id, From, To, Going, Held, Hops, Next) :-
    with_agent(Id, pass(Id, From, To, Going, Held, Next, Seconds)),
    From = Here-_,
    To = Name-plain(Address, _, _, _, _, _, _, _, _),
    arrival_finish_safely(Id, Here-Name, Address, Hops, Seconds, Next).

pass(Id, Here-From, Name-To, going(Module, Hash, Life, Until, Since),
     Hole-Goals, Next, Seconds) :-
    host_plain(Here, From),             % it still is
    agent_runs(Id),
    arg(2, From, Place0),
    arg(2, To, Place),
    agent_links(Module, Place0, Place, Links),
    host_passes(From, Name-To, Since, Seconds),
    !,
    agent_relink(Module, Links),
    ignore(Hole = true),
    agent_passes(Id, Name, Module, Hash, Life, Until),
    next(running, Here-Name, Goals, Next),
    ready_if_stopped(Next, Id, Goals).

conclude(ok, _, _, _, _).
conclude(ended, _, _, _, stop).
conclude(refused(Reason), Id, Here-Name, Hops, _) :-
    endpoint_address(Own),
    address_parts(Address, Name, Own),
    debug(typhon(hop), '~w hop ~D: stays, ~w', [Id, Hops, Reason]),
    event(hops, Here, Id, stayed(Address)),
    throw(error(move_refused(Address, Reason), _)).

%   moved(+Id, +Hosts, +Going, +Held, +Hops, -Next, -Verdict): Verdict is `ok`,
%   `ended`, or refused(unknown_host) of a host that is being stopped.

moved(Id, Hosts, Going, Held, Hops, Next, ok) :-
    with_agent(Id, move(Id, Hosts, Going, Held, Next, Seconds)),
    !,
    Hosts = _-Name,
    (   host(Name, Address, _)
    ->  arrival_finish_safely(Id, Hosts, Address, Hops, Seconds, Next)
    ;   true                            % it is being stopped
    ).
moved(Id, _, _, _, _, _, Verdict) :-
    (   agent(Id, _, _, _, _)
    ->  Verdict = refused(unknown_host)
    ;   Verdict = ended
    ).

%   An agent that was ordered to move has no hole.  Here and Name are counted
%   inside with_agent/2, so that an order to end the agent finds it counted on
%   the host where it is.

move(Id, Here-Name, going(Module0, Hash, Life, Until, Since), Hole-Goals0,
     Next, Seconds) :-
    host(Name, _, Place),
    agent_status(Id, Status, _),
    next(Status, Here-Name, Goals, Next),
    (   host(Here, _, Place0),
        agent_links(Module0, Place0, Place, Links)
    ->  Module = Module0,
        Goals = Goals0,
        agent_relink(Module, Links)
    ;   agent_state(Module0, State),
        agent_build(Id, Place, Hash, State-Goals0, Module-Goals)
    ),
    ignore(Hole = true),
    agent_move(Id, Name, Module, Life, Until),
    ready_if_stopped(Next, Id, Goals),
    seconds(Here, Name, Since, Seconds),
    host_hop(Here, out, Seconds),
    host_hop(Name, in, Seconds),
    host_leave(Here).                   % last: a host that stops waits for it

next(running, Here-Name, Goals, Next) :-
    (   schedule_stays(Here, Name)
    ->  Next = elsewhere(Goals)
    ;   Next = stop
    ).
next(obeying, _, _, stop).

ready_if_stopped(elsewhere(_), _, _).
ready_if_stopped(stop, Id, Goals) :-
    agent_put(Id, ready, Goals).

%   One of the hosts may have been stopped meanwhile.

seconds(Here, Name, Since, Seconds) :-
    (   ( host_time(Here, Now) ; host_time(Name, Now) )
    ->  Seconds is max(0.0, Now-Since)
    ;   Seconds = 0.0
    ).

%   The agent has moved: errors in reporting are only printed.

arrival_finish_safely(Id, Hosts, Address, Hops, Seconds, Next) :-
    catch(arrival_finish(Id, Hosts, Address, Hops, Seconds, Next),
          error(Formal, Context),
          print_error(error, error(Formal, Context))).

arrival_finish(Id, Here-Name, Address, Hops, Seconds, Next) :-
    debug(typhon(hop), '~w hop ~D: is on ~w, of this process',
          [Id, Hops, Address]),
    agent_seen(Id, Address, Hops, here),
    ignore(move_over(Id, answer(arrived))),
    arrival_event(Id, Here, Name, Seconds),
    (   Next == stop
    ->  schedule(Name, Id)
    ;   true
    ).

arrival_event(Id, Here, Name, Seconds) :-
    (   event_subscribed(hops),
        host(Here, From, _)
    ->  event(hops, Name, Id, arrived(From, Seconds))
    ;   true
    ).
