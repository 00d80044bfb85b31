:- module(test_chunks, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/random_programs').
:- use_module(library(typhon/kernel/program), [code_clear/0]).

/** <module> Tests of typhon_chunks: programs run as the machine runs them

`make fuzz-programs COUNT=10000` tries as many programs, from SEED on.
*/

:- begin_tests(chunks, [cleanup(code_clear)]).

test(random_programs_run_as_in_the_machine, Differing == []) :-
    number_from('TYPHON_PROGRAMS', 200, Count),
    number_from('TYPHON_SEED', 1, First),
    Last is First+Count-1,
    findall(Seed-Clauses-Difference,
            ( between(First, Last, Seed),
              set_random(seed(Seed)),
              once(random_program(Clauses)),
              engines_differ(Clauses, Difference)
            ),
            Differing).

number_from(Variable, Default, Number) :-
    (   getenv(Variable, Text)
    ->  atom_number(Text, Number)
    ;   Number = Default
    ).

:- end_tests(chunks).
