:- module(test_fuzz_tls, []).

% The short form of `make fuzz TLS=true`.

:- use_module('../lib/common').
:- use_module(fuzz_run).
:- use_module(library(plunit)).

:- needs([openssl]).

:- begin_tests(random_input_over_tls_does_no_harm).

test(few_hundred_inputs, Faults == []) :-
    no_leaks(fuzz([count(400), seed(1), tls(true)], Faults)).

:- end_tests(random_input_over_tls_does_no_harm).
