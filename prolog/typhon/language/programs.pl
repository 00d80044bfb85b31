:- module(typhon_programs,
          [ program_read/7,             % +Spec, -Program, -Initial, -Kinds,
                                        % -Places, -Sources, -Doubtful
            payload_load/2,             % +Spec, -Payload
            payload_file/1,             % +File
            program_terms/6,            % +Located, -Program, -Initial, -Kinds,
                                        % -Places, -Errors
            payload_terms/3,            % +Located, -Payload, -Errors
            in_file_order/3,            % +Problems, +Located, -Ordered
            problem_error/3,            % +Problem, +Others, -Error
            advice_text/2,              % +Advice, -Text
            payload_python/3,           % +Payload, -Name, -Source
            file_parts/4,               % +Kind, +Located, -Parts, -Problems
            part/3,                     % +What, +Parts, -Value
            library_directive/2,        % +Parts, -Library
            program_load/6              % +Spec, -Program, -Initial, -Hash,
                                        % -Kinds, -Places
          ]).

/** <module> Agent programs and payloads

An agent program is a clause file that begins with `:- agent(Name, Opts)`, a
payload one that begins with `:- payload(Name, Opts)`.  It is read into a plain
term:

  - program(Name, State, Libraries, Clauses): the immutable part. State
    are the predicate indicators of the mutable part, Libraries the
    imports by use_module/1,2, Clauses the static clauses as Head:-Body.
  - payload(Name, Predicates, Clauses)

A payload that was read from a file vision.py is called `vision`.  Its one
clause is a fact 'vision.py'(Source), so it is sent as any other payload, and a
host without Python treats it as text.

A problem is problem(Formal, Location, Advice): an ISO error, its place, and
how to fix it, see typhon_problem_text.

A program file is read, checked and analysed when the first agent is created
from it, and again when it, or a file that it includes, has changed.  A program
of clauses is read once for all variants of it.  The imports of a library are
its exports at the time of reading.

*Threading*: any thread. One mutex to add a program; readers need none.
*/

:- use_module(library(apply), [maplist/2, maplist/3, maplist/4, partition/4]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [is_of_type/2, must_be/2, type_error/2]).
:- use_module(library(lists),
              [ append/3, member/2, memberchk/2, nth1/3, same_length/2,
                selectchk/3 ]).
:- use_module(library(pairs), [pairs_values/2]).
:- autoload(library(readutil), [read_file_to_string/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/names', [names_near/3]).
:- use_module('../kernel/base/on_demand', [on_demand_load/2]).
:- use_module('../kernel/base/prolog_faults', [forget_erased/0]).
:- use_module('../kernel/program',
              [ clause_parts/3, control/1, indicator_in/2, mobile_predicates/3,
                program_hash/2 ]).
:- use_module(library_data, [import_fault/2, library_import/2]).
:- use_module(source,
              [ declaration/4, program_file/2, reader_directive/1,
                source_same/1, source_settled/1, source_terms/5 ]).

:- setting(typhon_loaded:files, nonneg, 64, "Programs remembered as they were read").

:- dynamic
    loaded/3.                           % File or hash of clauses, Sources, Loaded: the
                                        % oldest first

:- multifile
    typhon_on_demand:joins/2,
    payload_was_read/2,                 % Spec, Payload: was read from a file
    problem_at_goal/2,                  % +Problem0, -Problem: with the line of its goal
    advice//1,                          % +Advice: parts of the text, none where the
                                        % error says enough
    program_used/2,                     % File, Hash: a program is used from its file
    read_anew/4,                        % File or hash of clauses, Hash, Sources,
                                        % Doubtful, see program_read/7
    unknown/3.                          % Hash, State, :Offered: an agent of this
                                        % program is created, with these predicates in
                                        % its state: print, once for each program, those
                                        % that it calls and that nothing defines, but no
                                        % Problem for which call(Offered, Problem)
                                        % succeeds

typhon_on_demand:joins(program, text).

%!  program_read(+Spec, -Program, -Initial, -Kinds, -Places, -Sources,
%!               -Doubtful) is det.
%
%   Read an agent program.
%
%   @arg Initial are the clauses of its state predicates: the state of an
%        agent at birth.
%   @arg Kinds is the result of mobile_predicates/3.
%   @arg Places are the places of its clauses, see typhon_code.
%   @arg Sources are the files that were read, see source_terms/5.
%   @arg Doubtful is doubtful(Located, Kinds, Once), for warnings that do
%        not keep it from running: the terms as read, and problems that
%        were found in reading.
%   @error The first problem that keeps the program from running, with the
%        others in its context, see problem_error/3.

program_read(Spec, Program, Initial, Kinds, Places, Sources,
             doubtful(Located, Kinds, Once)) :-
    source_terms(Spec, Located, Sources, Unread, Once),
    no_problems(Unread),
    program_terms(Located, Program, Initial, Kinds, Places0, Errors),
    no_problems(Errors),
    Program = program(_, _, _, Clauses),
    places_named(Places0, Clauses, Sources, Places).

%!  payload_load(+Spec, -Payload) is det.
%
%   Read a payload file, which may be Python, or payload(Name, Predicates,
%   Clauses) itself.

payload_load(payload(Name, PIs, Clauses), Payload) :-
    !,
    must_be(atom, Name),
    must_be(list, PIs),
    maplist(must_be_indicator, PIs),
    must_be(list, Clauses),
    Payload = payload(Name, PIs, Clauses).
payload_load(clauses(Terms), Payload) :-
    !,
    payload_read(clauses(Terms), Payload).
payload_load(Spec, Payload) :-
    (   python_payload(Spec, Payload0)
    ->  Payload = Payload0
    ;   payload_read(Spec, Payload)
    ),
    forall(payload_was_read(Spec, Payload), true).

must_be_indicator(PI) :-
    (   subsumes_term(_/_, PI),
        PI = Name/Arity,
        is_of_type(atom, Name),
        is_of_type(nonneg, Arity)
    ->  true
    ;   must_be(ground, PI),
        type_error(predicate_indicator, PI)
    ).

payload_read(Spec, Payload) :-
    source_terms(Spec, Located, _, Unread, _),
    no_problems(Unread),
    payload_terms(Located, Payload, Errors),
    no_problems(Errors).

%!  payload_file(+File) is semidet.
%
%   File holds a payload, not an agent.

payload_file(File) :-
    python_payload(File, _),
    !.
payload_file(File) :-
    source_terms(File, Located, _, _, _),
    member(Term-_, Located),
    declaration(payload, Term, _, _),
    !.

no_problems([]) :-
    !.
no_problems(Problems) :-
    on_demand_load(program, read),
    maplist(problem_at_goal, Problems, [Problem|Others]),
    problem_error(Problem, Others, Error),
    throw(Error).

%!  problem_error(+Problem, +Others:list, -Error) is det.
%
%   Error is Problem, with Others in its context: error(Formal, at(Location,
%   Text, Others)), where Text is how to fix it.  Prolog would replace a
%   context/2 of its own by a backtrace of the reader when the error is not
%   caught.

problem_error(problem(Formal, Location, Advice), Others,
              error(Formal, at(Location, Text, Others))) :-
    advice_text(Advice, Text).

%!  advice_text(+Advice, -Text:atom) is det.

advice_text(Advice, Text) :-
    phrase(advice(Advice), Parts),
    atomic_list_concat(Parts, Text).

%!  program_terms(+Located, -Program, -Initial, -Kinds, -Places,
%!                -Errors:list) is det.
%
%   As program_read/7, for terms with their locations.  Errors, in the order of
%   the file, keep the program from running.

program_terms(Located, program(Name, State, Libraries, Static), Initial,
              Kinds, Places, Errors) :-
    file_parts(agent, Located, Parts, Errors0),
    part(name, Parts, Name),
    part(state, Parts, State),
    part(rules, Parts, Rules),
    findall(Library, library_directive(Parts, Library), Libraries),
    partition(in_state(State), Rules, Initial0, Static0),
    findall(Problem, file_problem(agent, Located, Parts, Problem), Errors1),
    append(Errors0, Errors1, Errors2),
    analyse(Errors2, Static0, Kinds, Errors3),
    in_file_order(Errors3, Located, Errors),
    maplist(located_clause, Static0, Static),
    maplist(located_clause, Initial0, Initial),
    pairs_values(Static0, Locations),
    places(Locations, Places).

%   The program is not analysed if it has errors.

analyse([], Static, Kinds, Errors) :-
    !,
    mobile_predicates(Static, Kinds, Errors).
analyse(Errors, _, [], Errors).

%!  payload_terms(+Located, -Payload, -Errors:list) is det.
%
%   Payload as in payload_load/2. Errors keep it from being used.

payload_terms(Located, payload(Name, PIs, Clauses), Errors) :-
    file_parts(payload, Located, Parts, Errors0),
    part(name, Parts, Name),
    part(options, Parts, Options),
    part(clauses, Parts, Clauses0),
    findall(Problem, file_problem(payload, Located, Parts, Problem), Errors1),
    append(Errors0, Errors1, Errors2),
    in_file_order(Errors2, Located, Errors),
    provided(Options, Provided),
    maplist(located_clause, Clauses0, Clauses),
    findall(PI, clause_indicator(Clauses, PI), Defined),
    append(Provided, Defined, PIs0),
    sort(PIs0, PIs).

%   Options that are no list are a problem of the declaration.

provided(Options, Provided) :-
    (   memberchk(provides(Provided0), Options),
        is_list(Provided0)
    ->  Provided = Provided0
    ;   Provided = []
    ).

%!  in_file_order(+Problems, +Located, -Ordered) is det.
%
%   Problems whose location is not in Located come first.

in_file_order(Problems0, Located, Problems) :-
    maplist(position(Located), Problems0, Keyed0),
    keysort(Keyed0, Keyed),
    pairs_values(Keyed, Problems).

position(Located, Problem, N-Problem) :-
    Problem = problem(_, Location, _),
    (   nth1(N0, Located, _-Location)
    ->  N = N0
    ;   N = 0
    ).

                /*******************************
                *            PLACES            *
                *******************************/

%   places(+Locations:list, -Places) is det.
%
%   Locations are those of the clauses, see typhon_source.

places([File:Line|Locations], [File-[Line|Lines]|Places]) :-
    !,
    in_file(Locations, File, Lines, Rest),
    places(Rest, Places).
places(_, []).

in_file([File:Line|Locations], File, [Line|Lines], Rest) :-
    !,
    in_file(Locations, File, Lines, Rest).
in_file(Rest, _, [], Rest).

%   places_named(+Places0, +Clauses, +Sources, -Places) is det.
%
%   Places are Places0, of Clauses, with the names of variables from Sources,
%   see source_terms/5.

places_named([], _, _, Places) =>
    Places = [].
places_named(Places0, Clauses, Sources, Places) =>
    findall(File:Line, ( member(File-Lines, Places0), member(Line, Lines) ),
            Locations),
    maplist(names_of(Sources), Locations, Clauses, Lists),
    append(Places0, [names(Lists)], Places).

names_of(Sources, Location, Clause, Names) :-
    (   findall(Found, member(names(Location, Found), Sources), [Names0]),
        term_variables(Clause, Variables),
        same_length(Variables, Names0)
    ->  Names = Names0
    ;   Names = []
    ).

                /*******************************
                *            PYTHON            *
                *******************************/

%   python_payload(+Spec, -Payload) is semidet: fails if Spec does not end in
%   `.py`.
%
%   @error existence_error(source_sink, Spec)

python_payload(Spec, payload(Name, [Functor/1], [(Fact:-true)])) :-
    base(Spec, Base),
    file_name_extension(Name, py, Base),
    absolute_file_name(Spec, File, [access(read)]),
    read_file_to_string(File, Source, [encoding(utf8)]),
    functor_of(Name, Functor),
    Fact =.. [Functor, Source].

base(Spec, Base) :-
    compound(Spec),
    compound_name_arguments(Spec, _, [Path]),
    !,
    base(Path, Base).
base(Spec, Base) :-
    ( atom(Spec) ; string(Spec) ),
    file_base_name(Spec, Base).

functor_of(Name, Functor) :-
    atom_concat(Name, '.py', Functor).

%!  payload_python(+Payload, -Name, -Source:string) is semidet.

payload_python(payload(Name, [Functor/1], [Clause]), Name, Source) :-
    functor_of(Name, Functor),
    Clause = (Fact:-true),
    Fact =.. [Functor, Source],
    string(Source).

                /*******************************
                *            PARTS             *
                *******************************/

%!  file_parts(+Kind, +Located, -Parts, -Problems:list) is det.
%
%   Parts are the parts of a file that declares an `agent` or a `payload`, Kind.
%   Problems has one element if this declaration is missing.

file_parts(Kind, Located, parts(Name, Options, Directives, Clauses, Rules,
                                State), Problems) :-
    declared(Kind, Located, Name, Options, Rest, Problems),
    partition(is_directive, Rest, Directives, Clauses),
    maplist(located_rule, Clauses, Rules),
    findall(PI, state_indicator(Options, Directives, PI), State0),
    sort(State0, State).

%!  part(+What, +Parts, -Value) is det.
%
%   What is one of
%
%     - name, options: of the declaration
%     - directives: the others, each with its location
%     - clauses: each with its location
%     - rules: the same as (Head:-Body)
%     - state: indicators of the predicates that agents may change

part(name, parts(Name, _, _, _, _, _), Name).
part(options, parts(_, Options, _, _, _, _), Options).
part(directives, parts(_, _, Directives, _, _, _), Directives).
part(clauses, parts(_, _, _, Clauses, _, _), Clauses).
part(rules, parts(_, _, _, _, Rules, _), Rules).
part(state, parts(_, _, _, _, _, State), State).

declared(Kind, Located, Name, Options, Rest, []) :-
    member(Term-_, Located),
    declaration(Kind, Term, Name, Options),
    !,
    selectchk(Term-_, Located, Rest).
declared(Kind, Located, unknown, [], Located,
         [problem(existence_error(declaration, Kind), Location,
                  declare(Kind))]) :-
    (   member((:- Directive)-Location0, Located),
        compound(Directive),
        compound_name_arity(Directive, Kind, _)
    ->  Location = Location0            % meant as a declaration
    ;   Located = [_-Location0|_]
    ->  Location = Location0
    ;   Location = clause(0)
    ).

is_directive(Term-_) :-
    nonvar(Term),
    Term = (:- _).

located_rule(Term-Location, (Head:-Body)-Location) :-
    clause_parts(Term, Head, Body).

state_indicator(Options, _, PI) :-
    member(state(PIs), Options),
    indicator_in(PIs, PI).
state_indicator(_, Directives, PI) :-
    member((:- dynamic(PIs))-_, Directives),
    indicator_in(PIs, PI).

%   in_state(+State, +Rule): Rule, with its location, belongs to a predicate of
%   State.

in_state(State, (Head:-_)-_) :-
    callable(Head),
    functor(Head, Name, Arity),
    memberchk(Name/Arity, State).

%!  library_directive(+Parts, -Library) is nondet.
%
%   The file imports Library, as in library_import/2.

library_directive(Parts, Library) :-
    part(directives, Parts, Directives),
    member((:- Directive)-_, Directives),
    library_import(Directive, Library).

%!  located_clause(+Located, -Clause) is det.

located_clause(Term-_, Clause) :-
    (   clause_parts(Term, Head, Body),
        Body \== true
    ->  Clause = (Head:-Body)
    ;   clause_parts(Term, Clause, _)
    ).

%!  clause_indicator(+Clauses, -PI) is nondet.

clause_indicator(Clauses, Name/Arity) :-
    member(Clause, Clauses),
    clause_parts(Clause, Head, _),
    functor(Head, Name, Arity).

                /*******************************
                *           PROBLEMS           *
                *******************************/

%   file_problem(+Kind, +Located, +Parts, -Problem): Problem keeps the file
%   from being used, besides those of file_parts/4.

file_problem(_, _, Parts, problem(Formal, Location, Advice)) :-
    part(directives, Parts, Directives),
    member((:- Directive)-Location, Directives),
    faulty_directive(Directive, Formal, Advice).
file_problem(_, _, Parts, problem(Formal, Location, Advice)) :-
    part(clauses, Parts, Clauses),
    member(Term-Location, Clauses),
    clause_parts(Term, Head, Body),
    faulty_clause(Head, Body, Formal, Advice).
file_problem(agent, Located, Parts, Problem) :-
    part(rules, Parts, Rules),
    no_entry(Located, Rules, Problem).
file_problem(Kind, Located, _, problem(Formal, Location, Advice)) :-
    member(Term-Location, Located),
    declaration(Kind, Term, _, Options),
    !,
    member(Option, Options),
    faulty_option(Kind, Option, Formal, Advice).

faulty_directive(Directive, instantiation_error, directive) :-
    var(Directive),
    !.
faulty_directive(dynamic(PIs), Formal, Advice) :-
    !,
    faulty_indicator(PIs, Formal, Advice).
faulty_directive(discontiguous(_), _, _) :-
    !,
    fail.
faulty_directive(Directive, Formal, library) :-
    library_import(Directive, Import),
    !,
    import_fault(Import, Formal).
faulty_directive(Directive, Formal, Advice) :-
    functor(Directive, Kind, _),
    memberchk(Kind, [agent,payload]),
    !,
    (   declaration(Kind, (:- Directive), Name, _)
    ->  Formal = permission_error(declare, Kind, Name),
        Advice = once
    ;   Formal = domain_error(Kind, Directive),
        Advice = declare(Kind)
    ).
faulty_directive(Directive, Formal, directive) :-
    (   catch(reader_directive(Directive), error(Formal0, _), true)
    ->  nonvar(Formal0),
        Formal = Formal0
    ;   Formal = domain_error(directive, Directive)
    ).

%   faulty_indicator(+PIs, -Formal, -Advice) is nondet: a problem of PIs, the
%   argument of dynamic/1.

faulty_indicator(PIs, instantiation_error, indicator) :-
    var(PIs),
    !.
faulty_indicator([], _, _) :-
    !,
    fail.
faulty_indicator(PIs, Formal, Advice) :-
    ( PIs = [A|B] ; PIs = (A,B) ),
    !,
    ( Part = A ; Part = B ),
    faulty_indicator(Part, Formal, Advice).
faulty_indicator(Name/Arity, Formal, redefined) :-
    atom(Name),
    integer(Arity),
    Arity >= 0,
    !,
    functor(Head, Name, Arity),
    taken(Head, Formal).
faulty_indicator(PI, type_error(predicate_indicator, PI), indicator).

faulty_clause(Head, _, instantiation_error, head) :-
    var(Head),
    !.
faulty_clause(Head, _, type_error(callable, Head), head) :-
    \+ callable(Head),
    !.
faulty_clause(Head, _, domain_error(clause_head, Head), qualified) :-
    Head = _:_,
    !.
faulty_clause(Head, _, domain_error(clause, Head), rule) :-
    memberchk(Head, [(_=>_), (?-_), (_:-_)]),
    !.
faulty_clause(Head, _, Formal, redefined) :-
    taken(Head, Formal),
    !.
faulty_clause(_, Body, type_error(callable, Body), body) :-
    \+ is_body(Body).

%   taken(+Head, -Formal): the machine or Prolog defines Head already.

taken(Head, permission_error(modify, control_predicate, Name/Arity)) :-
    control(Head),
    !,
    functor(Head, Name, Arity).
taken(Head, permission_error(modify, static_procedure, Name/Arity)) :-
    (   '$get_predicate_attribute'(system:Head, iso, 1)
    ;   memberchk(Head, [(_*->_), ignore(_)])
    ),
    !,
    functor(Head, Name, Arity).

is_body(Body) :- var(Body), !.
is_body((A,B)) :- !, is_body(A), is_body(B).
is_body((A;B)) :- !, is_body(A), is_body(B).
is_body((A->B)) :- !, is_body(A), is_body(B).
is_body((A*->B)) :- !, is_body(A), is_body(B).
is_body(Body) :- callable(Body).

no_entry(Located, Rules,
         problem(existence_error(entry, main/0), Location, entry(Near))) :-
    findall(Name/Arity,
            ( member((Head:-_)-_, Rules), callable(Head),
              functor(Head, Name, Arity) ),
            PIs),
    \+ ( member(PI, PIs), is_entry(PI) ),
    Located = [_-Location|_],
    findall(PI-Entry,
            ( is_entry(Entry), Entry = Name/Arity, member(PI, PIs),
              PI = Written/Arity, names_near(Name, [Written], [_]) ),
            Near).

is_entry(main/0).
is_entry(on_message/2).

faulty_option(Kind, Option, Formal, Advice) :-
    nonvar(Option),
    lists(Kind, Option, PIs),
    is_list(PIs),
    !,
    faulty_indicator(PIs, Formal, Advice0),
    ( Advice0 == indicator -> Advice = options(Kind) ; Advice = Advice0 ).
faulty_option(Kind, Option, domain_error(Domain, Option), options(Kind)) :-
    atom_concat(Kind, '_declaration', Domain).

lists(agent, state(PIs), PIs).
lists(payload, provides(PIs), PIs).

                /*******************************
                *         LOADED FILES         *
                *******************************/

%!  program_load(+Spec, -Program, -Initial, -Hash, -Kinds, -Places) is det.
%
%   As program_read/7, with the hash of Program.  Prints warnings.

program_load(Spec, Program, Initial, Hash, Kinds, Places) :-
    load(Spec, loaded(Program, Initial, Hash, Kinds, Places)).

load(Spec, Loaded) :-
    callable(Spec),
    Spec \= clauses(_),
    !,
    program_file(Spec, File),
    load(File, File, Loaded).
load(clauses(Terms), Loaded) :-
    catch(variant_sha1(Terms, Hash), error(type_error(_, _), _), fail),
    !,
    load(Hash, clauses(Terms), Loaded).
load(Spec, Loaded) :-                   % invalid clauses: an error follows
    read_program(Spec, Loaded, _, _).

load(Key, Spec, Loaded) :-
    known(Key, Spec, Loaded),
    arg(3, Loaded, Hash),
    (   atom(Spec)
    ->  forall(program_used(Spec, Hash), true)
    ;   true
    ).

known(Key, _, Loaded) :-
    loaded(Key, Sources, Loaded0),
    source_same(Sources),
    !,
    Loaded = Loaded0.
known(Key, Spec, Loaded) :-
    read_program(Spec, Loaded, Sources, Doubtful),
    arg(3, Loaded, Hash),
    debug(typhon(program), 'read ~w', [Key]),
    on_demand_load(program, read),
    forall(read_anew(Key, Hash, Sources, Doubtful), true),
    (   source_settled(Sources)
    ->  with_mutex(typhon_programs, remember(Key, Sources, Loaded))
    ;   true
    ),
    forget_erased.

read_program(Spec, loaded(Program, Initial, Hash, Kinds, Places), Sources,
             Doubtful) :-
    program_read(Spec, Program, Initial, Kinds, Places, Sources, Doubtful),
    program_hash(Program, Hash).

remember(Key, Sources, Loaded) :-
    retractall(loaded(Key, _, _)),
    assertz(loaded(Key, Sources, Loaded)),
    forget_oldest.

forget_oldest :-
    predicate_property(loaded(_, _, _), number_of_clauses(Count)),
    setting(typhon_loaded:files, Max),
    Count > Max,
    loaded(Key, _, _),
    !,
    retractall(loaded(Key, _, _)),
    forget_oldest.
forget_oldest.
