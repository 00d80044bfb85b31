:- module(typhon_within,
          [ hop_within/6                % +Id, +Name, +Hole, +Goals, +Since,
                                        % -Next
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module('../wire', [endpoint_address/1, mobile_term/1]).
:- use_module('../host',
              [ address_parts/3, event/4, event_heard/1, guarding/0, host/3,
                host_enter/4, host_hop/3, host_leave/1, host_time/2, quota_any/1,
                schedule/2, schedule_stays/2 ]).
:- use_module('../agent',
              [ agent/5, agent_changed/4, agent_elsewhere/3, agent_may_stand/4,
                agent_mobile/2, agent_move/5, agent_put/3, agent_standing/5,
                agent_state/2, agent_status/3, life_hop/3, life_tokens/2,
                mail_count/2, policy_refuses/2, quota_against/3,
                with_agent/2 ]).
:- use_module(whereabouts, [agent_seen/4]).

/** <module> Hops between hosts of one process

Nothing has to be sent, answered or doubted: the record of the agent changes
in one step.  Its mail and its orders stay where they are, and mostly its
state does, too.  What the agent can see of a hop is as ever: what could not
travel does not, and its place is another.  Only the length of a frame does
not matter here.

*Threading*: in a worker, which has the agent.
*/

%!  hop_within(+Id, +Name, +Hole, +Goals, +Since, -Next) is det.
%
%   Id, which set out at Since, is on host Name of this process, with Goals,
%   its Hole bound to `true`; or it was ended meanwhile.  Next is `stop`, or
%   elsewhere(Goals) if it still has its worker.
%
%   @error type_error(mobile_term, Culprit)
%   @error move_refused(Address, Reason)

hop_within(Id, Name, Hole, Goals, Since, Next) :-
    agent(Id, Here, Module, Hash, Life0),
    !,
    life_hop(Life0, Life, Hops),
    can_travel(Id, Module, Life-Goals, Until),
    (   kept_out(Name, Id, Module, Hash, Goals, Reason)
    ->  How = refused(Reason)
    ;   sig_atomic(enter(Id, Here-Name, Hash-going(Life, Until), Hole-Goals,
                         How))
    ),
    went(How, Id, Here-Name, Hops, Since, Next).
hop_within(_, _, _, _, _, stop).        % it was ended

went(moved(Next), Id, Here-Name, Hops, Since, Next) :-
    sig_atomic(told(arrived(Id, Here, Name, Hops, Since, Next))).
went(ended, _, _, _, _, stop).
went(refused(Reason), Id, Here-Name, Hops, _, _) :-
    endpoint_address(Own),
    address_parts(Address, Name, Own),
    debug(typhon(hop), '~w hop ~D: stays, ~w', [Id, Hops, Reason]),
    event(hops, Here, Id, stayed(Address)),
    throw(error(move_refused(Address, Reason), _)).

kept_out(Name, Id, Module, Hash, _, Reason) :-
    quota_any(Name),
    mail_count(Id, Mail),
    quota_against(Name, newcomer(Id, Hash, module(Module), Mail), Reason),
    !.
kept_out(Name, _, Module, Hash, Goals, Reason) :-
    guarding,
    host(Name, _, Place),
    catch(( agent_may_stand(Module, Hash, Place, Goals), fail ),
          error(Formal, Context),
          policy_refuses(error(Formal, Context), Reason)).

%   Of the state only what has changed since it was last looked at.

can_travel(Id, Module, Others, Until) :-
    (   agent_mobile(Id, Since)
    ->  true
    ;   Since = 0                       % it was ended
    ),
    agent_changed(Module, Since, Clauses, Until),
    mobile_term(Clauses-Others).

%   enter(+Id, +Hosts, +HashAndGoing, +Held, -How): How is moved(Next), `ended`, or
%   refused(Reason).  Nobody keeps the room that was taken for one who does
%   not come.

enter(Id, Here-Name, Hash-Going, Held, How) :-
    Going = going(Life, _),
    life_tokens(Life, Tokens),
    host_enter(Name, Hash, Tokens, Answer),
    (   Answer == ok
    ->  catch(moved(Id, Here-Name, Going, Held, Left, How), Ball,
              ( host_leave(Name),
                throw(Ball) )),
        host_leave(Left)
    ;   How = Answer
    ).

moved(Id, Here-Name, Going, Held, Here, moved(Next)) :-
    with_agent(Id, move(Id, Here-Name, Going, Held, Next)),
    !.
moved(Id, _-Name, _, _, Name, refused(unknown_host)) :-
    agent(Id, _, _, _, _),              % Name is being stopped
    !.
moved(_, _-Name, _, _, Name, ended).

%   The agent is there, whatever comes: nobody must think it is still here.

:- meta_predicate told(0).

told(Goal) :-
    catch(Goal, error(Formal, Context),
          print_message(error, error(Formal, Context))).

%   An agent that was told to move has no hole.

move(Id, Here-Name, going(Life, Until), Hole-Goals0, Next) :-
    host(Name, _, Place),
    agent_status(Id, Status, _),
    next(Status, Here-Name, Goals, Next),
    agent(Id, _, Module0, Hash, _),
    (   host(Here, _, Place0),
        agent_elsewhere(Module0, Place0, Place)
    ->  Module = Module0,
        Goals = Goals0
    ;   agent_state(Module0, State),
        agent_standing(Id, Place, Hash, State-Goals0, Module-Goals)
    ),
    ignore(Hole = true),
    agent_move(Id, Name, Module, Life, Until),
    (   Next == stop
    ->  agent_put(Id, ready, Goals)
    ;   true
    ).

next(running, Here-Name, Goals, Next) :-
    (   schedule_stays(Here, Name)
    ->  Next = elsewhere(Goals)
    ;   Next = stop
    ).
next(obeying, _, _, stop).

arrived(Id, Here, Name, Hops, Since, Next) :-
    host(Name, Address, _),
    endpoint_address(Own),
    !,
    debug(typhon(hop), '~w hop ~D: is on ~w, of this process',
          [Id, Hops, Address]),
    agent_seen(Id, Address, Hops, Own),
    took(Here, out, Since, _),
    took(Name, in, Since, Seconds),
    came(Id, Here, Name, Seconds),
    (   Next == stop
    ->  schedule(Name, Id)
    ;   true
    ).
arrived(_, _, _, _, _, _).              % it is being stopped

took(Host, Direction, Since, Seconds) :-
    (   host_time(Host, Now)
    ->  Seconds is max(0.0, Now-Since),
        host_hop(Host, Direction, Seconds)
    ;   Seconds = 0.0                   % the host was stopped meanwhile
    ).

came(Id, Here, Name, Seconds) :-
    (   event_heard(hops),
        host(Here, From, _)
    ->  event(hops, Name, Id, arrived(From, Seconds))
    ;   true
    ).
