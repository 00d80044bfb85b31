% Sends words to a friend, echoes the words that it receives, travels if it
% has a route, and records duplicates.

:- agent(gossip, [state([todo/1, route/1, said/1, back/1, heard/1, friend/1,
                         early/2, wrong/1])]).

said(0).
back(0).
heard(0).

main :-
    receive(_-friend(Friend)),
    assertz(friend(Friend)),
    talk.

talk :-
    todo(N),
    said(N),
    back(N),
    heard(N),
    !,
    findall(W, wrong(W), Wrong),
    result(Wrong).
talk :-
    say,
    walk,
    listen(0.01),
    talk.

say :-
    said(N),
    todo(N),
    !.
say :-
    retract(said(N0)),
    N is N0+1,
    assertz(said(N)),
    friend(Friend),
    self(Me),
    send(Friend, word(Me, N)).

% It stays where it is if it cannot get there.

walk :-
    said(N),
    N mod 5 =:= 0,
    retract(route([Host|Hosts])),
    !,
    append(Hosts, [Host], Route),
    assertz(route(Route)),
    catch(move(Host), error(_, _), true).
walk.

listen(Seconds) :-
    (   receive(_-What, Seconds)
    ->  take_in(What),
        listen(0)
    ;   true
    ).

take_in(word(Sender, N)) :-
    count(heard, N),
    send(Sender, echo(N)).
take_in(echo(N)) :-
    count(back, N).

% count(+What, +N): the N-th has come; words may come in any order.

count(What, N) :-
    Known =.. [What, N0],
    call(Known),
    (   ( N =< N0 ; early(What, N) )
    ->  assertz(wrong(twice(What, N)))
    ;   assertz(early(What, N)),
        catch_up(What)
    ).

catch_up(What) :-
    Known =.. [What, N0],
    call(Known),
    N is N0+1,
    (   retract(early(What, N))
    ->  retract(Known),
        Next =.. [What, N],
        assertz(Next),
        catch_up(What)
    ;   true
    ).
