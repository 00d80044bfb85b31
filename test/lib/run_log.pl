:- module(test_run_log,
          [ suite_time/2                % +Line, -Time
          ]).

/** <module> What test/run.pl prints

*Threading*: any thread.
*/

:- use_module(library(lists), [append/3, subtract/3]).

%!  suite_time(+Line, -Time) is semidet.
%
%   Line is that of a suite, as
%
%       test_x.pl   12 passed   1.0 s   1.2 s of processor   1 FAILED
%
%   Time is time(Suite, Processor, Seconds, Failed).

suite_time(Line, time(Suite, Processor, Seconds, Failed)) :-
    split_string(Line, " ", " ", Words0),
    subtract(Words0, [""], Words),
    append([Suite, _, "passed", S, "s", P, "s", "of", "processor"], Rest,
           Words),
    failed(Rest, Failed),
    number_string(Seconds, S),
    number_string(Processor, P).

failed([], 0).
failed([Count, "FAILED"], Failed) :-
    number_string(Failed, Count).
