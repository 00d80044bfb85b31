:- module(sync_statements_potentials,
          [ potential_statement/4       % +Curves, -Text, -Held, -Found
          ]).
:- use_module(saying).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists),
              [ last/2, max_list/2, member/2, memberchk/2, min_list/2, nth1/3,
                reverse/2
              ]).

/** <module> What the thesis says of Figure 5.2

*Threading*: pure.
*/

%!  potential_statement(+Curves, -Text, -Held, -Found) is nondet.
%
%   Curves is a list of curve(Delta, Rewards, Steps), Delta rising.

potential_statement(Curves,
          'the larger delta, the sooner a potential is zero', Held, Found) :-
    findall(N, ( member(curve(_, _, Steps), Curves),
                 last(Steps, step(N, _, _)) ), Ns),
    truth(falling(Ns), Held),
    text('~w visits', [Ns], Found).
potential_statement(Curves, 'it falls fast first, and slowly at the end',
          Held, Found) :-
    findall(First-Last, ( member(curve(_, _, Steps), Curves),
                          ends(Steps, First, Last) ), Ends),
    truth(forall(member(First-Last, Ends), First > Last), Held),
    maplist([F-L, T]>>text('~2f and ~2f', [F, L], T), Ends, Texts),
    text('penalties, first and last: ~w', [Texts], Found).
potential_statement(Curves, 'a reward raises it for a while', Held, Found) :-
    findall(N, raised(Curves, N), Raised),
    findall(N, rewarded_below(Curves, N), All),
    length(Raised, Count),
    length(All, AllCount),
    truth(( AllCount > 0, Count =:= AllCount ), Held),
    text('~d of ~d rewards', [Count, AllCount], Found).
potential_statement(Curves,
          'the curves of theta differ at first, and meet at the end',
          Held, Found) :-
    findall(N, ( member(curve(_, _, Steps), Curves),
                 last(Steps, step(N, _, _)) ), Ns),
    min_list(Ns, End),
    Half is End // 2,
    findall(Spread, ( between(1, Half, I), spread(Curves, I, Spread) ),
            Spreads),
    max_list(Spreads, Most),
    spread(Curves, End, Least),
    truth(Least < Most, Held),
    text('~2f apart at most up to visit ~d, ~2f at visit ~d',
         [Most, Half, Least, End], Found).
potential_statement(Curves, 'the larger delta, the larger theta at the end',
          Held, Found) :-
    findall(Theta, ( member(curve(_, _, Steps), Curves),
                     last(Steps, step(_, _, Theta)) ), Thetas),
    reverse(Thetas, Reversed),
    truth(falling(Reversed), Held),
    decimals(Thetas, Texts),
    text('~w', [Texts], Found).

ends(Steps, First, Last) :-
    findall(Theta, penalty(Steps, Theta), Thetas),
    Thetas = [First|_],
    last(Thetas, Last).

penalty(Steps, Theta) :-
    nth1(I, Steps, step(_, P0, _)),
    I1 is I + 1,
    nth1(I1, Steps, step(_, P, Theta)),
    P < P0.

%   A reward where there was room for it.

rewarded_below(Curves, N) :-
    member(curve(_, Rewards, Steps), Curves),
    member(N, Rewards),
    N0 is N - 1,
    memberchk(step(N0, P0, _), Steps),
    P0 < 100.

raised(Curves, N) :-
    member(curve(_, Rewards, Steps), Curves),
    member(N, Rewards),
    N0 is N - 1,
    memberchk(step(N0, P0, _), Steps),
    P0 < 100,
    memberchk(step(N, P, _), Steps),
    P > P0.

spread(Curves, N, Spread) :-
    findall(Theta, ( member(curve(_, _, Steps), Curves),
                     memberchk(step(N, _, Theta), Steps) ), Thetas),
    min_list(Thetas, Least),
    max_list(Thetas, Most),
    Spread is Most - Least.

