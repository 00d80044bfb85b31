:- use_module('../lib/common').
:- use_module(library(plunit)).
:- use_module(lasting/attack).

:- needs([journal]).

:- begin_tests(lasting).

%   A few seconds of what `make chaos` does for long.

test('processes with journals die at their steps: nobody is lost or doubled',
     Wrong == []) :-
    with_tmp_dir(attacked([ processes(2), agents(40), hops(50),
                            crash(0.0002), kill(2) ], Wrong)).
test('the power fails: what was answered is not lost', Wrong == []) :-
    with_tmp_dir(attacked([ processes(2), agents(10), hops(20), sync(full),
                            crash(0), power(0.03) ], Wrong)).

attacked(Options, Wrong, Dir) :-
    random_between(1, 1000000, Seed),
    format('% seed ~d~n', [Seed]),
    lasting([dir(Dir), seed(Seed), seconds(120)|Options],
            report(Facts, Wrong)),
    format('% ~p~n', [Facts]).

:- end_tests(lasting).
