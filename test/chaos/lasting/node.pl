:- module(lasting_node, []).

/** <module> A process with a journal, which dies at its steps

    swipl node.pl -- NAME PORT DIR SYNC SEED PROBABILITY

Starts the host NAME; prints `ready`; ends with its standard input.  At each
step of the journal, see typhon_crash, it kills itself with PROBABILITY.

*Threading*: the main thread; steps in any.
*/

:- use_module('../../../prolog/typhon').
:- use_module(library(main), [main/0]).
:- use_module(library(process), [process_kill/2]).

:- initialization(main, main).

:- dynamic probability/1.

:- multifile typhon_crash:reached/1.

typhon_crash:reached(Point) :-
    probability(P),
    P > 0,
    random_float < P,
    format(user_error, 'dies at ~w~n', [Point]),
    current_prolog_flag(pid, Pid),
    process_kill(Pid, kill),
    sleep(1).

:- public main/1.

main([Name, Port0, Dir, Sync, Seed0, P0]) :-
    atom_number(Port0, Port),
    atom_number(Seed0, Seed),
    atom_number(P0, P),
    set_random(seed(Seed)),
    set_prolog_flag(verbose, silent),
    assertz(probability(P)),
    host_start(Name, [journal(Dir), sync(Sync), port(Port)]),
    format('ready~n'),
    flush_output,
    read_term(_, []),
    halt.
