:- module(test_suites,
          [ all_suites/1,               % -Files
            left_out_suites/2,          % +Names, -Skipped
            suite_name/2,               % +File, -Name
            suite_named/2,              % +Name, -File
            of_studies/1,               % +File
            runs_plainly/1              % +File
          ]).

/** <module> The test suites of this project, and their names

A suite test/prolog/kernel/wire/test_frame.pl is named `frame`, or by its path,
or, with all others of its folder, `prolog/kernel/wire`.

*Threading*: any thread.
*/

:- use_module('../../app/packaging/parts', [left_out/2]).
:- use_module(common, [project_file/2]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [member/2]).

%!  all_suites(-Files:list) is det.
%
%   Each process looks for them once.

:- table all_suites/1.

all_suites(Files) :-
    project_file(test, Test),
    findall(File, suite_in(Test, File), Files0),
    sort(Files0, Files).

suite_in(Dir, File) :-
    directory_member(Dir, File, [recursive(true), extensions([pl])]),
    suite_name(File, _).

%!  left_out_suites(+Names, -Skipped:list) is det.
%
%   Skipped are the suites, File-Part, of parts that are left out: all of them,
%   or those with Names.

left_out_suites(Names, Skipped) :-
    findall(File-Part,
            ( left_out(Path, Part),
              sub_atom(Path, 0, _, _, 'test/'),
              suite_name(Path, _),
              project_file(Path, File),
              once(( Names == []
                   ; member(Name, Names),
                     is_named(Name, File)
                   )) ),
            Skipped0),
    sort(Skipped0, Skipped).

%!  suite_name(+File, -Name) is semidet.
%
%   Fails if File is no suite.

suite_name(File, Name) :-
    file_base_name(File, Base),
    atom_concat(test_, Rest, Base),
    file_name_extension(Name, pl, Rest).

%!  suite_named(+Name, -File) is nondet.
%
%   File is absolute.

suite_named(Name, File) :-
    all_suites(Files),
    member(File, Files),
    is_named(Name, File).

is_named(Name, File) :-
    suite_name(File, Name),
    !.
is_named(Name, File) :-
    project_file(Name, File),
    !.
is_named(Name, File) :-
    format(atom(Relative), 'test/~w', [Name]),
    project_file(Relative, Dir),
    atom_concat(Dir, /, Start),
    sub_atom(File, 0, _, _, Start),
    !.

%!  of_studies(+File) is semidet.

of_studies(File) :-
    sub_atom(File, _, _, _, 'test/experiments/').

%!  runs_plainly(+File) is semidet.
%
%   The suite runs without a saved state: it checks how the library is loaded, or
%   the options of swipl, or starts attackers that know only the wire protocol.

runs_plainly(File) :-
    suite_name(File, Name),
    plain(Name).

plain(pack).
plain(parts).
plain(shell).
plain(search).
plain(site).
plain(child_output).
plain(locale).
plain(attackers).
plain(kernel).
plain(single).
plain(user_program).
plain(kinds).
plain(node_program).
plain(on_demand).
