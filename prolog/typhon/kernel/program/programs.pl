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
            program_hash/2,             % +Program, -Hash
            payload_python/3            % +Payload, -Name, -Source
          ]).
:- use_module(library(apply), [maplist/2, maplist/3, partition/4]).
:- use_module(library(error), [is_of_type/2, must_be/2, type_error/2]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, nth1/3]).
:- use_module(library(pairs), [pairs_values/2]).
:- autoload(library(readutil), [read_file_to_string/3]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module(mobile, [mobile_predicates/3]).
:- use_module(parts,
              [ clause_indicator/2, file_parts/4, file_problem/4, in_state/2,
                library_directive/2, located_clause/2, part/3 ]).
:- use_module(places, [places/2, places_named/4]).
:- use_module(source, [declaration/4, source_terms/5]).
:- use_module(paths, []).

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

*Threading*: any thread; this module has no state.
*/

:- multifile
    payload_was_read/2,         % Spec, Payload: was read from a file
    problem_at_goal/2,          % +Problem0, -Problem: with the line of its goal
    advice//1.                  % +Advice: parts of the text, none where the
                                % error says enough

%!  program_read(+Spec, -Program, -Initial, -Kinds, -Places, -Sources,
%!               -Doubtful) is det.
%
%   Read an agent program.
%
%   @arg Initial are the clauses of its state predicates: the state of an
%        agent at birth.
%   @arg Kinds is the result of mobile_predicates/3.
%   @arg Places are the places of its clauses, see typhon_places.
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
                *             HASH             *
                *******************************/

%!  program_hash(+Program, -Hash:atom) is det.
%
%   The name of Program: SHA-256 of its canonical text, the same on every
%   Prolog version and word size.

program_hash(Program, Hash) :-
    Program = program(_, State, Libraries, Clauses),
    with_output_to(string(Text),
                   forall(member(Term, [State,Libraries|Clauses]),
                          print_canonical(Term))),
    sha_hash(Text, Bytes, [algorithm(sha256), encoding(utf8)]),
    hash_atom(Bytes, Hash).

print_canonical(Term) :-
    \+ \+ ( numbervars(Term, 0, _, [functor_name('$typhon_variable')]),
            write_term(Term, [ quoted(true), ignore_ops(true) ]),
            nl
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
