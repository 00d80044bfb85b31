:- module(test_fuzz, []).

% The fuzzer's short form; the long one is `make fuzz`.

:- use_module('../lib/common').
:- use_module(fuzz_run).
:- use_module(library(plunit)).

:- begin_tests(random_input_does_no_harm).

test(few_hundred_inputs, Faults == []) :-
    no_leaks(fuzz([count(600), seed(1)], Faults)).

:- end_tests(random_input_does_no_harm).
