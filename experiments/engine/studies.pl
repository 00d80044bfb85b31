:- module(study_studies,
          [ study_load/2,               % +File, -Study
            study_title/3,              % +Study, -Name, -Title
            study_call/2,               % +Study, :Goal
            study_says/2,               % +Study, +PI
            study_at_work/1,            % +Study
            study_name/3                % +Study, -Where, -Name
          ]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module('../../prolog/typhon/kernel/base/names', [names_joined/3, names_near/3]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module(cases, [parameters/3, study_parameter/2]).
:- use_module(sampling, [is_design/1, is_range/1]).
:- use_module(series, []).
:- use_module(claims, [claim_name/2, claim_shape/2, claim_value/2]).

/** <module> A study is a short file

A study defines parameters, one run, measures, claims and plots. Its
predicates are

    study(Name, Title).
    text(Paragraph).
    vary(Parameter, Values).
    fixed(Parameter, Value, Why).
    sample(Parameter, Range).
    design(Design).
    derive(Parameter, Case, Value).
    skip(Case).
    network(Case, Topology, Options).
    run(Case, Network).
    view(Log, View).
    measure(Name, View, Value).
    label(Name, Text).
    printed(Measure, Where, Value).
    claim(Text, Notes, Test).
    plot(Name, Title, Picture).
    progress(Case, What, Total).
    real(Where, Settings).

Only the first and measure/3 are required.  doc/studies.md explains each.
A case is a dict with the value of each parameter.

Why is one of printed(Where), assumed(Why), tuned(Why); the last is for a value
that was chosen after results had been seen.

*Threading*: studies are loaded by one thread.
*/

:- multifile
    prolog:error_message//1,
    prolog:message//1,
    typhon_options:declared/4,
    user:file_search_path/2.

:- dynamic
    user:file_search_path/2.

:- dynamic
    loaded/1.                   % Study

word(study/2).
word(text/1).
word(vary/2).
word(fixed/3).
word(sample/2).
word(design/1).
word(derive/3).
word(skip/1).
word(network/3).
word(run/2).
word(view/2).
word(measure/3).
word(label/2).
word(printed/3).
word(claim/3).
word(plot/3).
word(progress/3).
word(real/2).

%   library(typhon) in a study is the platform that the engine has loaded,
%   even if another one is installed.

:- prolog_load_context(directory, Engine),
   absolute_file_name('../../prolog', Platform,
                      [relative_to(Engine), file_type(directory)]),
   (   user:file_search_path(library, Platform)
   ->  true
   ;   asserta(user:file_search_path(library, Platform))
   ).

%!  study_load(+File, -Study) is det.
%
%   Study is the module of File, and has its name.  A file is loaded once.
%
%   @error study(File, Problems) if File is not a valid study

study_load(File, Study) :-
    absolute_file_name(File, Study, [file_type(prolog), access(read)]),
    (   loaded(Study)
    ->  true
    ;   forall(word(PI), ( Study:dynamic(PI), Study:discontiguous(PI) )),
        Study:import(study_series:counted/4),
        Study:import(study_series:stepped/4),
        statistics(errors, Before),
        load_files(Study:Study,
                   [encoding(utf8), silent(true), if(true)]),
        statistics(errors, After),
        findall(Problem, problem(Study, Before-After, Problem), Problems),
        complain(Problems, Study),
        forall(mistyped(Study, PI, Words),
               print_message(warning, study_mistyped(Study, PI, Words))),
        assertz(loaded(Study))
    ).

complain([], _) :-
    !.
complain(Problems, Study) :-
    throw(error(study(Study, Problems), _)).

%!  study_call(+Study, :Goal) is nondet.

study_call(Study, Goal) :-
    Study:Goal.

%!  study_says(+Study, +PI) is semidet.
%
%   Study has clauses for PI, one of the predicates above.

study_says(Study, Name/Arity) :-
    functor(Head, Name, Arity),
    predicate_property(Study:Head, number_of_clauses(Count)),
    Count > 0.

%!  study_at_work(+Study) is det.
%
%   Lets agents(Name) and payloads(Name) refer to files beside Study, too.

:- dynamic at_work/1.           % Directory

study_at_work(Study) :-
    file_directory_name(Study, Directory),
    retractall(at_work(_)),
    assertz(at_work(Directory)).

user:file_search_path(agents, Directory) :-
    at_work(Directory).
user:file_search_path(payloads, Directory) :-
    at_work(Directory).

%!  study_title(+Study, -Name, -Title) is det.

study_title(Study, Name, Title) :-
    once(study_call(Study, study(Name, Title))).

                /*******************************
                *           PROBLEMS           *
                *******************************/

problem(_, Before-After, errors) :-
    After > Before.
problem(Study, _, missing(Word)) :-
    member(Word, [study/2, measure/3]),
    \+ study_says(Study, Word).
problem(Study, _, arity(Name/Other, Word)) :-
    Word = Name/Arity,
    member(Word, [study/2, text/1, vary/2, fixed/3, claim/3, plot/3]),
    current_predicate(Study:Name/Other),
    Other =\= Arity,
    study_says(Study, Name/Other).
problem(Study, _, no_values(Name)) :-
    study_call(Study, vary(Name, Values)),
    \+ Values = [_|_].
problem(Study, _, no_range(Name, Range)) :-
    study_call(Study, sample(Name, Range)),
    \+ is_range(Range).
problem(Study, _, no_design(Design)) :-
    study_call(Study, design(Design)),
    \+ is_design(Design).
problem(Study, _, missing(design/1)) :-
    study_says(Study, sample/2),
    \+ study_says(Study, design/1).
problem(Study, _, said(claim(Text), no_test(Part))) :-
    study_call(Study, claim(Text, _, Test)),
    claim_shape(Study:Test, Part).
problem(Study, _, said(plot(Name), no_picture(Picture))) :-
    study_call(Study, plot(Name, _, Picture)),
    \+ is_picture(Picture).
problem(Study, _, said(plot(Name), wrong(Formal))) :-
    study_call(Study, plot(Name, _, Picture)),
    picture_options(Picture, Domain, Options),
    catch(( check_options(Domain, Options), fail ), error(Formal, _), true).
problem(Study, _, said(Where, unknown(Name))) :-
    study_name(Study, Where, Name),
    unknown(Study, Name).
problem(Study, _, said(Where, no_parameter(Name))) :-
    condition(Study, Where, Name),
    \+ study_parameter(Study, Name).
problem(Study, _, said(claim(Text), no_case(Name=Value))) :-
    study_call(Study, claim(Text, _, Test)),
    claim_value(Study:Test, Name=Value),
    atom(Value),
    parameters(Study, [], Parameters),
    memberchk(parameter(Name, Values, varied), Parameters),
    is_list(Values),
    \+ memberchk(Value, Values).

%   condition(+Study, -Where, -Name) is nondet: a condition Name=Value in Where, a
%   claim or a printed value.

condition(Study, claim(Text), Name) :-
    study_call(Study, claim(Text, _, Test)),
    claim_value(Study:Test, Name=_).
condition(Study, printed(Measure), Name) :-
    clause(Study:printed(Measure, Conditions, _), _),
    is_list(Conditions),
    member(Condition, Conditions),
    nonvar(Condition),
    ( Condition = (Name=_) -> nonvar(Name) ; Name = Condition ).

%!  study_name(+Study, -Where, -Name) is nondet.
%
%   Where, claim(Text) or plot(Plot), mentions Name as a measure or a parameter.

study_name(Study, claim(Text), Name) :-
    study_call(Study, claim(Text, _, Test)),
    claim_name(Study:Test, Name).
study_name(Study, plot(Plot), Name) :-
    study_call(Study, plot(Plot, _, Picture)),
    picture_options(Picture, _, Options),
    \+ Picture = script(_, _, _),
    member(Option, Options),
    (   Option = y(Measures),
        is_list(Measures)
    ->  member(Name, Measures)
    ;   member(Option, [x(Name), y(Name), line(Name)])
    ).

%   picture_options(+Picture, -Domain, -Options): see module picture.

picture_options(lines(Options), lines_option, Options).
picture_options(over_time(Options), over_time_option, Options).
picture_options(script(_, _, Options), script_option, Options).

typhon_options:declared(lines_option, x(X), nonvar, X).
typhon_options:declared(lines_option, y(X), nonvar, X).
typhon_options:declared(lines_option, line(X), nonvar, X).
typhon_options:declared(lines_option, where(X), list, X).
typhon_options:declared(lines_option, log(X), nonvar, X).
typhon_options:declared(lines_option, rule(X, Y), nonvar, X-Y).
typhon_options:declared(lines_option, subtitle(X), ground, X).
typhon_options:declared(lines_option, xlabel(X), ground, X).
typhon_options:declared(over_time_option, Option, Type, Value) :-
    typhon_options:declared(lines_option, Option, Type, Value),
    Option \= x(_).
typhon_options:declared(script_option, size(W, H), list(integer), [W,H]).
typhon_options:declared(script_option, seed(X), oneof([first]), X).
typhon_options:declared(script_option, variables(X), callable, X).

is_picture(lines(_)).
is_picture(over_time(_)).
is_picture(script(_, _, _)).
is_picture(file(_, _)).

%   mistyped(+Study, -PI, -Words) is nondet: a predicate of Study whose name
%   resembles Words.  It may also be a predicate of the study's own.

mistyped(Study, Name/Arity, Words) :-
    current_predicate(Study:Name/Arity),
    functor(Head, Name, Arity),
    \+ predicate_property(Study:Head, imported_from(_)),
    findall(Word/Arity, word(Word/Arity), All),
    \+ memberchk(Name/Arity, All),
    names_near(Name, All, Words),
    Words \== [].

%   The names of measures are known only if all clauses of measure/3 name them.

unknown(Study, Name) :-
    findall(Measure, clause(Study:measure(Measure, _, _), _), Measures),
    \+ ( member(Measure, Measures), var(Measure) ),
    \+ ( member(Measure, Measures), Measure == Name ),
    \+ study_parameter(Study, Name).

prolog:message(study_mistyped(File, PI, Words)) -->
    { names_joined(Words, ' or ', Text) },
    [ '~w: ~q is not a predicate of studies (did you mean ~w?)'-
      [File, PI, Text] ].

prolog:error_message(study(File, Problems)) -->
    [ '~w is not a valid study'-[File] ],
    problems(Problems).

problems([]) --> [].
problems([Problem|Problems]) -->
    [ nl, '  ' ],
    says(Problem),
    problems(Problems).

says(errors) -->
    [ 'it has errors when it is loaded'-[] ].
says(missing(Word)) -->
    [ 'it does not define ~q'-[Word] ].
says(arity(PI, Word)) -->
    [ 'it defines ~q; studies have ~q'-[PI, Word] ].
says(no_values(Name)) -->
    [ 'vary(~q, Values): Values is not a list of values'-[Name] ].
says(no_range(Name, Range)) -->
    [ 'sample(~q, ~q): ranges are uniform(A, B), loguniform(A, B), \c
integer(A, B) and lists'-[Name, Range] ].
says(no_design(Design)) -->
    [ 'design(~q): designs are random(N) and latin_hypercube(N)'-[Design] ].
says(said(Where, Problem)) -->
    [ '~p: '-[Where] ],
    says(Problem).
says(no_test(Part)) -->
    [ '~q is not a test'-[Part] ].
says(no_picture(Part)) -->
    [ '~q is not a picture'-[Part] ].
says(wrong(Formal)) -->
    '$messages':translate_message(error(Formal, _)).
says(no_parameter(Name)) -->
    [ '~q is not a parameter'-[Name] ].
says(no_case(Name=Value)) -->
    [ 'no case has ~q=~q'-[Name, Value] ].
says(unknown(Name)) -->
    [ '~q is neither a measure nor a parameter'-[Name] ].
