:- use_module('../lib/common').
:- use_module(library(plunit)).
:- use_module(lasting/attack).

:- needs([journal]).

:- begin_tests(lasting).

%   A few seconds of what `swipl test/chaos/lasting/run.pl` does for long.

test('processes with journals die at their steps: nobody is lost or doubled',
     Wrong == []) :-
    with_tmp_dir(attacked(Wrong)).

attacked(Wrong, Dir) :-
    random_between(1, 1000000, Seed),
    format('% seed ~d~n', [Seed]),
    lasting([ dir(Dir), processes(2), agents(4), hops(40), crash(0.004),
              seed(Seed), seconds(90) ], report(Facts, Wrong)),
    format('% ~p~n', [Facts]).

:- end_tests(lasting).
