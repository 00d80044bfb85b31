:- module(study_studies,
          [ study_load/2,               % +File, -Study
            study_title/3,              % +Study, -Name, -Title
            study_parameters/2,         % +Study, -Parameters
            study_cases/3,              % +Study, +Given, -Cases
            study_call/2,               % +Study, :Goal
            has_network/1,              % +Study
            case_name/3                 % +Study, +Case, -Name
          ]).
:- use_module(library(error), [domain_error/2, existence_error/2]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).

/** <module> A study is a short file

A study says what varies, what is fixed, what one run is, what is measured,
what is claimed and what is drawn.  Its words are

    study(Name, Title).
    text(Paragraph).
    vary(Parameter, Values).
    fixed(Parameter, Value, Why).
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

Only the first and measure/3 are required.  doc/studies.md explains each.
A case is a dict: of each parameter its value.

Why is one of printed(Where), assumed(Why), chosen(Why), the last for what
was chosen after results had been seen.

*Threading*: studies are loaded by one thread.
*/

:- dynamic
    loaded/2.                   % File, Study

word(study/2).
word(text/1).
word(vary/2).
word(fixed/3).
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

%!  study_load(+File, -Study) is det.
%
%   Study is the module of File.  A file is loaded once.
%
%   @error existence_error(study, File) if it has no study/2 or no
%          measure/3

study_load(File0, Study) :-
    absolute_file_name(File0, File,
                       [file_type(prolog), access(read)]),
    (   loaded(File, Study)
    ->  true
    ;   Study = File,
        forall(word(Name/Arity), declare(Study, Name/Arity)),
        load_files(Study:File, [silent(true)]),
        complete(Study),
        assertz(loaded(File, Study))
    ).

declare(Study, PI) :-
    Study:dynamic(PI),
    Study:discontiguous(PI).

complete(Study) :-
    (   study_call(Study, study(_, _)),
        predicate_property(Study:measure(_, _, _), number_of_clauses(N)),
        N > 0
    ->  true
    ;   existence_error(study, Study)
    ).

%!  study_call(+Study, :Goal) is nondet.

study_call(Study, Goal) :-
    Study:Goal.

%!  study_title(+Study, -Name, -Title) is det.

study_title(Study, Name, Title) :-
    once(study_call(Study, study(Name, Title))).

%!  study_parameters(+Study, -Parameters:list) is det.
%
%   Parameters are parameter(Name, Value, Why) in the order of the file:
%   for one that varies Value is a list and Why is `varied`.  The engine's
%   own come last.  What varies is not fixed, and of what is fixed twice, in
%   a file that is included and by the study, the last counts.

study_parameters(Study, Parameters) :-
    findall(parameter(Name, Value, Why),
            parameter(Study, Name, Value, Why), Parameters).

parameter(Study, Name, Values, varied) :-
    study_call(Study, vary(Name, Values)).
parameter(Study, Name, Value, Why) :-
    findall(fixed(N, V, W), study_call(Study, fixed(N, V, W)), All),
    append(_, [fixed(Name, Value, Why)|Later], All),
    \+ memberchk(fixed(Name, _, _), Later),
    \+ study_call(Study, vary(Name, _)).
parameter(Study, Name, Value, Why) :-
    own_parameter(Study, Name, Value, Why),
    \+ study_call(Study, fixed(Name, _, _)),
    \+ study_call(Study, vary(Name, _)).

%   Of studies that have a network.

own_parameter(Study, clock, virtual, default) :-
    has_network(Study).
own_parameter(Study, processes, 1, default) :-
    has_network(Study).

%!  has_network(+Study) is semidet.

has_network(Study) :-
    predicate_property(Study:network(_, _, _), number_of_clauses(N)),
    N > 0.

%!  study_cases(+Study, +Given:list(pair), -Cases:list(dict)) is det.
%
%   All combinations of what varies, but for those to be skipped, in the
%   order of the file: what is named first varies slowest.  Given, pairs
%   Name-Value, take the place of what the file says; a list is varied.
%
%   @error domain_error(parameter, Name) for a name the study does not have

study_cases(Study, Given, Cases) :-
    known(Study, Given),
    findall(Case, study_case(Study, Given, Case), Cases).

known(Study, Given) :-
    forall(member(Name-_, Given),
           (   named(Study, Name)
           ->  true
           ;   domain_error(parameter, Name)
           )).

named(Study, Name) :-
    parameter(Study, Name, _, _).
named(Study, Name) :-
    clause(Study:derive(Name0, _, _), _),
    Name0 == Name.

study_case(Study, Given, Case) :-
    findall(Name-Values, values(Study, Given, Name, Values), Lists),
    choice(Lists, Pairs),
    dict_pairs(Case0, case, Pairs),
    derived(Study, Given, Case0, Case),
    \+ study_call(Study, skip(Case)).

values(Study, Given, Name, Values) :-
    parameter(Study, Name, Value, Why),
    (   memberchk(Name-Other, Given)
    ->  as_list(Other, Values)
    ;   Why == varied
    ->  Values = Value
    ;   Values = [Value]
    ).

as_list(Values, Values) :-
    is_list(Values),
    !.
as_list(Value, [Value]).

choice([], []).
choice([Name-Values|Lists], [Name-Value|Pairs]) :-
    member(Value, Values),
    choice(Lists, Pairs).

%   What follows from other parameters, unless it was given.

derived(Study, Given, Case0, Case) :-
    findall(Name-Value, derived_one(Study, Given, Case0, Name, Value), Pairs),
    dict_create(More, case, Pairs),
    Case = Case0.put(More).

derived_one(_, Given, Case, Name, Value) :-
    member(Name-Value, Given),
    \+ get_dict(Name, Case, _).
derived_one(Study, Given, Case, Name, Value) :-
    study_call(Study, derive(Name, Case, Value)),
    \+ memberchk(Name-_, Given).

%!  case_name(+Study, +Case, -Name:atom) is det.
%
%   What varies, for people: delta=0.5,topology=ring.

case_name(Study, Case, Name) :-
    findall(Part,
            ( study_call(Study, vary(Parameter, _)),
              get_dict(Parameter, Case, Value),
              format(atom(Part), '~w=~w', [Parameter, Value]) ),
            Parts),
    atomic_list_concat(Parts, ',', Name0),
    atomic_list_concat(Words, '/', Name0),     % it names a directory, too
    atomic_list_concat(Words, ':', Name1),
    (   Name1 == ''
    ->  Name = case
    ;   Name = Name1
    ).
