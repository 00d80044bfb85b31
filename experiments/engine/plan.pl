:- module(study_plan,
          [ plans/3,                    % +Studies, +Options, -Plans
            planned/4,                  % +Plans, +Options, -N, -Run
            planned_real/3,             % +Plans, +Options, -Run
            real_way/3,                 % +Options, -Title, -Changes
            planned_seed/2,             % +Options, -Seed
            planned_case/4,             % +Plans, +Text, -Study, -Case
            out_directory/2,            % +Options, -Directory
            runs_directory/2            % +Options, -Root
          ]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, nth1/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(cases, [case_name/3, study_cases/3]).
:- use_module(cross_check, [real_case/5]).
:- use_module(machines, [machines/3]).

/** <module> The runs that the options of a command select, and their
    directories

A plan is a term plan(Study, Given, Cases): the values of --set, and the
resulting cases.

*Threading*: no state; any thread.
*/

:- multifile
    prolog:error_message//1.

%!  plans(+Studies, +Options, -Plans:list) is det.
%
%   @error domain_error('NAME=VALUE', Text) and other errors of --set

plans(Studies, Options, Plans) :-
    given(Options, Given),
    findall(plan(Study, Given, Cases),
            ( member(Study, Studies), study_cases(Study, Given, Cases) ),
            Plans).

%   given(+Options, -Given): the values of --set, as pairs; for a repeated name
%   the last value.

given(Options, Given) :-
    findall(Name-Value,
            ( append(_, [set(Text)|Later], Options),
              setting(Text, Name, Value),
              \+ ( member(set(Other), Later), setting(Other, Name, _) ) ),
            Given).

setting(Text, Name, Value) :-
    (   sub_atom(Text, B, _, A, =),
        A > 0
    ->  sub_atom(Text, 0, B, _, Name),
        sub_atom(Text, _, A, 0, ValueText),
        value(ValueText, Value)
    ;   domain_error('NAME=VALUE', Text)
    ).

%   A value that is not a term, or is a variable, is text; a malformed
%   compound term is an error.

value(Text, Value) :-
    catch(term_to_atom(Value, Text), error(syntax_error(_), _), fail),
    !,
    ( ground(Value) -> true ; Value = Text ).
value(Text, _) :-
    sub_atom(Text, _, 1, _, Char),
    memberchk(Char, ['[', ']', '(', ')', '{', '}', ',']),
    domain_error(value, Text).
value(Text, Text).

%!  planned(+Plans, +Options, -N, -Run) is nondet.
%
%   Run is a run to make, of the case with the number N.  The first runs of all
%   cases come before the second ones.

planned(Plans, Options, N, run(Study, Case, Seed)) :-
    planned_seed(Options, Seed),
    member(plan(Study, _, Cases), Plans),
    nth1(N, Cases, Case).

%!  planned_real(+Plans, +Options, -Run) is nondet.
%
%   Run is a run to make in a real_way/3: one for each case by default, because
%   real runs take long.

planned_real(Plans, Options, run(Study, Real, Seed)) :-
    real_way(Options, _, Changes),
    option(real_runs(Runs), Options, 1),
    member(plan(Study, _, Cases), Plans),
    real_case(Study, Cases, Changes, _, Real),
    planned_seed([runs(Runs)|Options], Seed).

%!  real_way(+Options, -Title, -Changes:list) is nondet.
%
%   A real case is run with Changes: with --real on sockets of this machine, and
%   on --machines, with a process on each.

real_way(Options, 'on sockets', Changes) :-
    option(real(true), Options),
    real_clock(Options, Changes).
real_way(Options, 'on machines',
         [processes=Count, on_machines=at(Here, Machines)|Changes]) :-
    machines(Options, Here, Machines),
    length(Machines, Count),
    real_clock(Options, Changes).

real_clock(Options, Changes) :-
    findall(clock=Rate, option(real_clock(Rate), Options), Changes).

%!  planned_seed(+Options, -Seed) is nondet.

planned_seed(Options, Seed) :-
    option(seed(First), Options, 1),
    option(runs(Runs), Options, 3),
    Last is First + Runs - 1,
    between(First, Last, Seed).

%!  planned_case(+Plans, +Text, -Study, -Case) is det.
%
%   Text is the number or the name of the case; the parts of the name may be in
%   any order.
%
%   @error no_study_case(Text, Names)

planned_case(Plans, Text, Study, Case) :-
    member(plan(Study, _, Cases), Plans),
    the_case(Text, Study, Cases, Case),
    !.
planned_case(Plans, Text, _, _) :-
    findall(Name,
            ( member(plan(Study, _, Cases), Plans),
              member(Case, Cases),
              case_name(Study, Case, Name) ),
            Names),
    throw(error(no_study_case(Text, Names), _)).

the_case(Text, _, Cases, Case) :-
    atom_number(Text, N),
    !,
    nth1(N, Cases, Case).
the_case(Text, Study, Cases, Case) :-
    parts(Text, Parts),
    member(Case, Cases),
    case_name(Study, Case, Name),
    parts(Name, Parts).

parts(Name, Sorted) :-
    atomic_list_concat(Parts, ',', Name),
    msort(Parts, Sorted).

%!  out_directory(+Options, -Directory) is det.
%!  runs_directory(+Options, -Root) is det.
%
%   The directories of tables and pictures, and of runs.

out_directory(Options, Out) :-
    option(out(Out0), Options, 'out/studies'),
    absolute_file_name(Out0, Out).

runs_directory(Options, Root) :-
    out_directory(Options, Out),
    directory_file_path(Out, runs, Root).

prolog:error_message(no_study_case(Text, Names)) -->
    [ 'case ~w does not exist; cases are '-[Text] ],
    first_names(Names).

first_names(Names) -->
    { length(Some, 4),
      append(Some, [_|_], Names),
      !,
      atomic_list_concat(Some, '  ', Shown) },
    [ '~w  ...'-[Shown] ].
first_names(Names) -->
    { atomic_list_concat(Names, '  ', Shown) },
    [ '~w'-[Shown] ].
