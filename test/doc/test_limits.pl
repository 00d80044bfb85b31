:- module(test_limits, []).
:- use_module('../lib/common').
:- use_module('../lib/texts', [file_lines/2]).
:- use_module(library(plunit)).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting_property/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/index), [part_setting/6]).

/** <module> The table of amounts in doc/limits.md

*Threading*: one test at a time.
*/

:- begin_tests(limits).

test(bounds_of_the_table_are_those_of_the_program, Wrong-Some == []-true) :-
    findall(Module:Name-Bound, bound_of_table(Module, Name, Bound), Bounds),
    findall(Setting-Bound,
            ( member(Setting-Bound, Bounds), \+ has_default(Setting, Bound) ),
            Wrong),
    ( length(Bounds, Count), Count >= 8 -> Some = true ; Some = Bounds ).

:- end_tests(limits).

%   A row has `module:name` and its default.

bound_of_table(Module, Name, Bound) :-
    project_file('doc/limits.md', File),
    file_lines(File, Lines),
    member(Line, Lines),
    split_string(Line, "`", "", [_,_,_|_]),
    split_string(Line, "`", "", Parts),
    append(_, [Span,After|_], Parts),
    sub_string(Span, 0, _, _, "typhon_"),
    split_string(Span, ":", "", [Module0,Name0]),
    normalize_space(string(After1), After),
    split_string(After1, " ", "", [Number0|_]),
    split_string(Number0, ",", "", Digits),
    atomics_to_string(Digits, Number),
    number_string(Bound, Number),
    atom_string(Module, Module0),
    atom_string(Name, Name0).

has_default(Module:Name, Bound) :-
    (   setting_property(Module:Name, default(Default))
    ;   part_setting(Name, Module, _, Default, _, _)
    ),
    Default =:= Bound,
    !.
