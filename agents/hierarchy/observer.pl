:- agent(observer, [state([leaders/1, report/3, memory/1])]).
:- include('../lib/keep').
:- include(orders).

/*  The entity on top of a hierarchy (thesis section 8.2): collects the reports
    of all leaders for a round, and changes the parameters of the levels
    below.  It decides by the same payload as a leader without an observer
    (leader.pl), but from all reports together. The fact leaders(Count) is the
    number of leaders.
*/

on_message(Leader, report(Round, Report)) :-
    assertz(report(Round, Leader, Report)),
    leaders(Count),
    findall(One-Its, report(Round, One, Its), Reports0),
    (   length(Reports0, Count)
    ->  retractall(report(Round, _, _)),
        sort(Reports0, Reports),
        orders(Reports, Orders),
        log(decided(Round, Orders)),
        forall(member(One-Changes, Orders), send(One, change(Round, Changes)))
    ;   true
    ).
