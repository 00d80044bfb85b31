:- module(test_manual, []).
:- use_module(library(plunit)).
:- use_module('../../lib/common').
:- use_module(library(lists)).

/** <module> Tests of help and apropos for the predicates of the library
*/

%   answers(+Goal, -Text): the output of a Prolog that has loaded the library.

answers(Goal, Text) :-
    project_file('prolog/typhon.pl', Typhon),
    run_swipl(['-l', Typhon, '-g', Goal, '-t', halt], [], Status, Out, Err),
    assertion(Status == exit(0)),
    string_concat(Out, Err, Text).

occurs(Part, Text, Count) :-
    findall(x, sub_string(Text, _, _, _, Part), Xs),
    length(Xs, Count).

:- begin_tests(manual, [condition(exists_source(library(help)))]).

test(help_prints_once, Counts == [1,1,1,0]) :-
    answers('help(agent_create), help(agent_move)', Text),
    findall(Count,
            ( member(Part, ["Create an agent", "creation.pl",
                            "agent_move(+Agent, +Host)", "Warning"]),
              occurs(Part, Text, Count) ),
            Counts).

%   The manual need not be installed.

test(apropos_finds_our_predicates, Missing == []) :-
    answers('use_module(library(help)), \c
             use_module(library(pldoc/man_index)), \c
             apropos(\'Tuple space\'), apropos(xyzzyx), \c
             assertz(prolog_manual_index:man_index(agent_of/1, "", f, m, 0)), \c
             apropos(agent)', Text),
    findall(Part,
            ( member(Part, ["agent_create/3", "agent_check/1", "agent_of/1",
                            "leave/1", "No matches for xyzzyx"]),
              \+ occurs(Part, Text, 1) ),
            Missing).

:- end_tests(manual).
