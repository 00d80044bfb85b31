:- agent(supervisor,
         [ state([ child/3, strategy/1, intensity/2, standby/1, primary/1,
                   running/2, stood/2, pending/1, restarted/1, told/1,
                   looked/1 ]) ]).
:- use_module(library(typhon)).
:- include(supervision/places).

/*  Starts children, and restarts them when they end, as the supervisors of
    OTP do. Facts configure it:

      child(Name, Program, Options)   in the order in which they are started.
                      Options are those of create/3, restart(permanent),
                      restart(transient) or restart(temporary), and
                      where(Place), see supervision/places.pl
      strategy(one_for_one), one_for_all or rest_for_one
      intensity(Count, Seconds)       after more than Count restarts in
                      Seconds all children are ended, and the supervisor is
                      disposed of
      standby(Host)   another supervisor on Host takes over when this one is
                      lost; the two monitor each other

    Messages: children, with the answer children(Pairs), Name-Agent;
    restart(Name); and `stop`, which ends the children, the last one first,
    and then the supervisor.  A child is disposed of if its supervisor ends.
*/

main :-
    primary(Primary),
    !,
    monitor(Primary),
    watch(Primary).
main :-
    supervise.

supervise :-
    stand_by,
    findall(Name, child(Name, _, _), Names),
    start_all(Names),
    serve.

%   Failed starts are retried once a second.

serve :-
    patience(Patience),
    (   receive(From-Message, Patience)
    ->  true
    ;   Message = again
    ),
    served(Message, From).

patience(1) :-
    ( pending(_) ; standby(_) ),
    !.
patience(inf).

served(stop, _) :-
    !,
    findall(Name, running(Name, _), Names),
    stop_all(Names).
served(Message, From) :-
    ignore(handle(Message, From)),
    serve.

handle(down(Agent, _), system) :-
    retract(running(standby, Agent)),
    !,
    stand_by.
handle(down(Agent, Outcome), system) :-
    retract(running(Name, Agent)),
    log(down(Name, Outcome)),
    ended(Name, Outcome).
handle(again, _) :-
    tell_where,
    look_again,
    keep_apart,
    (   running(standby, _)
    ->  true
    ;   stand_by
    ),
    findall(Name, pending(Name), Names),
    start_all(Names).
handle(supervisor_at(There), Standby) :-
    running(standby, Standby),
    !,
    retractall(stood(standby, _)),
    assertz(stood(standby, There)).
handle(supervisor_at(_), Stray) :-      % its creation was not confirmed
    Stray \== user,
    end(Stray).
handle(children, From) :-
    findall(Name-Agent, ( running(Name, Agent), Name \== standby ), Pairs),
    tell(From, children(Pairs)).
handle(restart(Name), _) :-
    again(Name).

%   ended(+Name, +Outcome): the child Name has ended by itself.

ended(Name, Outcome) :-
    child(Name, _, Options),
    option(restart(Restart), Options, permanent),
    (   starts_again(Restart, Outcome)
    ->  too_many(TooMany),
        restart(TooMany, Name)
    ;   true
    ).

starts_again(permanent, _).
starts_again(transient, Outcome) :-
    Outcome \== done.

too_many(TooMany) :-
    ( intensity(Most, Seconds) -> true ; Most = 3, Seconds = 5 ),
    now(Now),
    Since is Now-Seconds,
    assertz(restarted(Now)),
    forget_before(Since),
    aggregate_all(count, restarted(_), Count),
    ( Count > Most -> TooMany = true ; TooMany = false ).

forget_before(Since) :-                 % the oldest fact is the first
    restarted(Then),
    !,
    (   Then < Since
    ->  retract(restarted(Then)),
        forget_before(Since)
    ;   true
    ).

restart(true, Name) :-
    log(gives_up(Name)),
    findall(Running, running(Running, _), Names),
    stop_all(Names),
    dispose.
restart(false, Name) :-
    again(Name).

%   again(+Name): restarts Name, with the children that depend on it.

again(Name) :-
    findall(Child, child(Child, _, _), All),
    ( strategy(Strategy) -> true ; Strategy = one_for_one ),
    with_it(Strategy, Name, All, Names),
    stop_all(Names),
    log_restarts(Names),
    start_all(Names).

log_restarts(Names) :-
    length(Names, Count),
    (   Count =< 5
    ->  log(restarts(Names))
    ;   append([A,B,C], _, Names),
        Others is Count-3,
        log(restarts([A,B,C,others(Others)]))
    ).

with_it(one_for_one, Name, _, [Name]).
with_it(one_for_all, _, All, All).
with_it(rest_for_one, Name, All, Rest) :-
    append(_, [Name|Others], All),
    !,
    Rest = [Name|Others].

                /*******************************
                *        START AND STOP        *
                *******************************/

start_all([]).
start_all([Name|Names]) :-
    start(Name),
    start_all(Names).

start(Name) :-
    child(Name, Program, Options0),
    option(where(Where), Options0, same),
    places(Where, Name, Options0, Places),
    exclude(of_supervisor, Options0, Options),
    begun(Places, Program, [name(Name)|Options], no(place), Begun),
    started(Begun, Name).

%   begun(+Places, +Program, +Options, +Begun0, -Begun): Begun is
%   on(Host, Agent), or no(Problem) of the last place.

begun([], _, _, Begun, Begun).
begun([Host|Hosts], Program, Options, _, Begun) :-
    catch(( create(Program, Agent, [host(Host),follows(true)|Options]),
            monitored(Agent),
            Begun0 = on(Host, Agent) ),
          error(Problem, _),
          Begun0 = no(Problem)),
    (   Begun0 = on(_, _)
    ->  Begun = Begun0
    ;   begun(Hosts, Program, Options, Begun0, Begun)
    ).

monitored(Agent) :-
    catch(monitor(Agent), error(Problem, Context),
          ( end(Agent), throw(error(Problem, Context)) )).

started(on(Host, Agent), Name) :-
    retractall(pending(Name)),
    retractall(stood(Name, _)),
    assertz(stood(Name, Host)),
    assertz(running(Name, Agent)),
    tell_standby(started(Name, Agent)).
started(no(_), Name) :-
    pending(Name),
    !.
started(no(Problem), Name) :-
    log(not_started(Name, Problem)),
    assertz(pending(Name)).

of_supervisor(host(_)).
of_supervisor(name(_)).
of_supervisor(where(_)).
of_supervisor(restart(_)).

%   In reverse order; each child has ended before the next is disposed of.

stop_all(Names) :-
    findall(Name-Agent, ( member(Name, Names), running(Name, Agent) ), Pairs0),
    reverse(Pairs0, Pairs),
    retract_pending(Names),
    stop_each(Pairs).

retract_pending(Names) :-
    forall(member(Name, Names), retractall(pending(Name))).

stop_each([]).
stop_each([Name-Agent|Pairs]) :-
    retractall(running(Name, Agent)),
    monitor(Agent),
    end(Agent),
    (   receive(system-down(Agent, _), 10)
    ->  true
    ;   catch(dispose(Agent, [force(0)]), error(_, _), true)
    ),
    stop_each(Pairs).

end(Agent) :-
    catch(dispose(Agent), error(_, _), true).

                /*******************************
                *            STANDBY           *
                *******************************/

%   The standby has the same facts, and knows the children: it ends those that
%   may have survived the primary before it starts others.

stand_by :-
    (   standby(Wanted),
        elsewhere(Wanted, Host),
        self(Me),
        here(Here),
        findall(Fact, inherited(Fact), Facts),
        catch(create(self, Agent,
                     [host(Host),facts([primary(Me),standby(Here)|Facts])]),
              error(_, _), fail)
    ->  assertz(running(standby, Agent)),
        retractall(stood(standby, _)),
        assertz(stood(standby, Host)),
        monitor(Agent)
    ;   true
    ).

%   elsewhere(+Wanted, -Host): Host is Wanted or a neighbour, outside the
%   processes of this agent and its home if possible: it is lost with either.

elsewhere(Wanted, Host) :-
    apart_from_here(Wanted, Host),
    !.
elsewhere(Wanted, Wanted).

apart_from_here(Wanted, Host) :-
    neighbours(Hosts),
    member(Host, [Wanted|Hosts]),
    apart([Host]).

apart(Hosts) :-
    here(Here),
    home(Home),
    \+ ( member(Host, Hosts),
         member(Own, [Here,Home]),
         one_process(Host, Own) ).

one_process(A, B) :-
    after_at(A, Endpoint),
    after_at(B, Endpoint).

%   after_at(+Atom, -Rest): Rest is the endpoint of an address, or the home in
%   the id of an agent.

after_at(Atom, Rest) :-
    sub_atom(Atom, At, 1, _, @),
    !,
    From is At+1,
    sub_atom(Atom, From, _, 0, Rest).

%   The supervisor or the standby may have hopped to a process of the other.

keep_apart :-
    (   running(standby, Standby),
        stood(standby, There),
        after_at(Standby, Home),
        \+ apart([There,Home]),
        standby(Wanted),
        apart_from_here(Wanted, _)
    ->  retract(running(standby, Standby)),
        end(Standby),
        stand_by
    ;   true
    ).

inherited(child(Name, Program, Options)) :-
    child(Name, Program, Options).
inherited(strategy(Strategy)) :-
    strategy(Strategy).
inherited(intensity(Count, Seconds)) :-
    intensity(Count, Seconds).
inherited(running(Name, Agent)) :-
    running(Name, Agent).

watch(Primary) :-
    (   receive(From-Message, 1)
    ->  true
    ;   Message = again
    ),
    watched(Message, From, Primary).

watched(down(Primary, Outcome), system, Primary) :-
    !,
    (   memberchk(Outcome, [done, disposed])
    ->  true
    ;   retractall(primary(_)),
        log(takes_over(Primary)),
        findall(Name, running(Name, _), Names),
        stop_all(Names),
        supervise
    ).
watched(started(Name, Agent), Primary, Primary) :-
    !,
    retractall(running(Name, _)),
    assertz(running(Name, Agent)),
    watch(Primary).
watched(_, _, Primary) :-
    tell_where,
    look_again,
    watch(Primary).

%   Each of the two knows the process of the other, which may have hopped.  So
%   it can end the other there if the home of the other is lost.

tell_where :-
    here(Here),
    (   told(Here)
    ->  true
    ;   retractall(told(_)),
        assertz(told(Here)),
        forall(primary(Primary), tell(Primary, supervisor_at(Here))),
        tell_standby(supervisor_at(Here))
    ).

%   A `down` message is lost with the process to which this agent tried to hop.
%   Monitoring an agent again has no effect, or produces the message again.
%   An agent whose creation was not confirmed, or was confirmed at a host that
%   this agent has left, follows this agent, but is not among its children:
%   it is ended.  A standby reports its own address.

look_again :-
    now(Now),
    \+ ( looked(Before), Now-Before < 5 ),
    !,
    retractall(looked(_)),
    assertz(looked(Now)),
    retractall(told(_)),
    forall(looked_after(Agent), catch(monitor(Agent), error(_, _), true)),
    (   primary(_)
    ->  true
    ;   followers(Agents),
        forall(( member(Agent, Agents), \+ running(_, Agent) ), end(Agent))
    ).
look_again.

looked_after(Agent) :-
    (   primary(_)
    ->  primary(Agent)
    ;   running(_, Agent)
    ).

tell_standby(Message) :-
    (   running(standby, Standby)
    ->  tell(Standby, Message)
    ;   true
    ).

tell(Agent, Message) :-
    catch(send(Agent, Message), error(_, _), true).
