:- module(lasting_agents,
          [ program/2                   % ?Name, -Program
          ]).

/** <module> What the agents do while processes die

*Threading*: facts only.
*/

%!  program(?Name, -Program) is nondet.
%
%   `hopper` goes so many hops, with each fourth counts at the host, and tells
%   a sink;
%   `porter` carries tokens; `talker` counts aloud to a sink; `sink` keeps the
%   accounts;
%   `gossip` says words to a friend, says back those it hears, travels if it
%   has a route, and notes what comes twice.

program(hopper, clauses([
    (:- agent(hopper, [state([todo/1, route/1, sink/1, made/1])])),
    made(0),
    (main :- made(N), todo(N), !, result(made(N))),
    (main :-
        route([Host|Hosts]),
        go(Host),
        retract(route(_)),
        append(Hosts, [Host], Route),
        assertz(route(Route)),
        retract(made(N0)),
        N is N0+1,
        assertz(made(N)),
        (   N mod 4 =:= 0
        ->  count,
            sink(Sink),
            self(Me),
            send(Sink, hop(Me, N))
        ;   true
        ),
        main),
    (go(Host) :-
        catch(( move(Host), Where = there ), error(_, _), Where = here),
        gone(Where, Host)),
    gone(there, _),
    (gone(here, Host) :- sleep(0.05), go(Host)),
    (count :- take(visits(V0)), !, V is V0+1, leave(visits(V))),
    (count :- leave(visits(1))) ])).
program(porter, clauses([
    (:- agent(porter, [state([todo/1, route/1, holds/1])])),
    (main :- todo(0), !, drop, result(done)),
    (main :-
        retract(todo(N0)), N is N0-1, assertz(todo(N)),
        route([Host|Hosts]),
        go(Host),
        retract(route(_)),
        append(Hosts, [Host], Route),
        assertz(route(Route)),
        change,
        main),
    (change :- retract(holds(T)), !, leave(token(T))),
    (change :- take(token(T)), !, assertz(holds(T))),
    change,
    (drop :- retract(holds(T)), !, leave(token(T))),
    drop,
    (go(Host) :-
        catch(( move(Host), Where = there ), error(_, _), Where = here),
        gone(Where, Host)),
    gone(there, _),
    (gone(here, Host) :- sleep(0.05), go(Host)) ])).
program(talker, clauses([
    (:- agent(talker, [state([todo/1, said/1, sink/1])])),
    said(0),
    (main :- said(N), todo(N), !, result(said(N))),
    (main :-
        retract(said(N0)), N is N0+1, assertz(said(N)),
        sink(Sink), self(Me),
        send(Sink, word(Me, N)),
        sleep(0.01),
        main) ])).
program(sink, clauses([
    (:- agent(sink, [state([heard/2, hops/3, wrong/3])])),
    (on_message(_, hop(Who, N)) :-
        (   retract(hops(Who, Count0, Sum0))
        ->  true
        ;   Count0 = 0, Sum0 = 0
        ),
        Count is Count0+1, Sum is Sum0+N,
        assertz(hops(Who, Count, Sum))),
    (on_message(_, word(Who, N)) :-
        ( retract(heard(Who, N0)) -> true ; N0 = 0 ),
        ( N =:= N0+1 -> true ; assertz(wrong(Who, N0, N)) ),
        assertz(heard(Who, N))) ])).
program(gossip, clauses([
    (:- agent(gossip, [state([todo/1, route/1, said/1, back/1, heard/1,
                              friend/1, early/2, wrong/1])])),
    said(0),
    back(0),
    heard(0),
    (main :-
        receive(_-friend(Friend)),
        assertz(friend(Friend)),
        talk),
    (talk :-
        todo(N), said(N), back(N), heard(N),
        !,
        findall(W, wrong(W), Wrong),
        result(Wrong)),
    (talk :-
        say,
        walk,
        listen(0.01),
        talk),
    (say :- said(N), todo(N), !),
    (say :-
        retract(said(N0)), N is N0+1, assertz(said(N)),
        friend(Friend), self(Me),
        send(Friend, word(Me, N))),
    (walk :-
        said(N), N mod 5 =:= 0,
        route([Host|Hosts]),
        !,
        catch(move(Host), error(_, _), true),
        retract(route(_)),
        !,
        append(Hosts, [Host], Route),
        assertz(route(Route))),
    walk,
    (listen(Seconds) :-
        (   receive(_-What, Seconds)
        ->  take_in(What),
            listen(0)
        ;   true
        )),
    (take_in(word(Who, N)) :- count(heard, N), send(Who, echo(N))),
    (take_in(echo(N)) :- count(back, N)),
    (count(What, N) :-
        Known =.. [What, N0],
        call(Known),
        (   ( N =< N0 ; early(What, N) )
        ->  assertz(wrong(twice(What, N)))
        ;   assertz(early(What, N)),
            catch_up(What)
        )),
    (catch_up(What) :-
        Known =.. [What, N0],
        call(Known),
        N is N0+1,
        (   retract(early(What, N))
        ->  retract(Known),
            Next =.. [What, N],
            assertz(Next),
            catch_up(What)
        ;   true
        )) ])).
