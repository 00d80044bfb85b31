:- use_module(library(filesex), [copy_file/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(terms), [mapargs/3]).
:- use_module(library(typhon), except([network_start/3])).
:- use_module(library(typhon/network), []).

/*  play(Folder) answers the queries in its file session.pl, one after the other,
    and writes what they answer into the file `answers`.  Networks are written to
    logs.  Natively and in WebAssembly all files are the same then, see
    test_playground.pl. */

:- prolog_load_context(directory, Here),
   absolute_file_name('../../..', Project, [relative_to(Here)]),
   asserta(user:file_search_path(project, Project)).

:- dynamic
    known/2,                            % Name, Value: of $Name
    count/1.                            % networks

%   As the library's, with a seed and a log.

network_start(Topology, Network, Options0) :-
    with_seed(Options0, Options1),
    with_log(Options1, Options),
    typhon_network:network_start(Topology, Network, Options).

with_seed(Options, Options) :-
    memberchk(seed(_), Options),
    !.
with_seed(Options, [seed(1)|Options]).

with_log(Options, Options) :-
    ( memberchk(log(_), Options) ; memberchk(log(_, _), Options) ),
    !.
with_log(Options, [log(File, Kinds)|Options]) :-
    Kinds = [hops, messages, facts, faults, links, hosts],
    retract(count(N)),
    N1 is N+1,
    assertz(count(N1)),
    atomic_list_concat([network, N, '.log'], File).

play(Folder) :-
    working_directory(_, Folder),
    set_random(seed(1)),
    retractall(known(_, _)),
    retractall(count(_)),
    assertz(count(0)),
    setup_call_cleanup(
        ( open('session.pl', read, In, [encoding(utf8)]),
          open(answers, write, Out, [encoding(utf8)]) ),
        with_output(Out, play_all(In)),
        ( close(In),
          close(Out) )).

:- meta_predicate with_output(+, 0).

with_output(Out, Goal) :-
    current_output(Old),
    setup_call_cleanup(set_output(Out), Goal, set_output(Old)).

play_all(In) :-
    read_term(In, Term, [module(user), variable_names(Names)]),
    (   Term == end_of_file
    ->  forall(network_property(Network, seed(_)), network_stop(Network)),
        forall(host_property(Host, state(running)), host_stop(Host))
    ;   Term = (?- Goal),
        query(Goal, Names),
        play_all(In)
    ).

query(Goal0, Names) :-
    known_values(Goal0, Names, Goal),
    catch(answer(Goal, Names), error(Formal, _), shown(error(Formal))).

answer(Goal, Names) :-
    (   user:Goal
    ->  forall(( member(Name=Value, Names), nonvar(Value) ),
               ( retractall(known(Name, _)),
                 assertz(known(Name, Value)) )),
        shown(Names)
    ;   shown(false)
    ).

shown(Term) :-
    \+ \+ ( numbervars(Term, 0, _, [attvar(bind)]),
            format('~W~n', [Term, [quoted(true), numbervars(true)]]) ).

known_values($(Var), Names, Value) :-
    var(Var),
    member(Name=Same, Names),
    Same == Var,
    known(Name, Value),
    !.
known_values(Term, Names, Result) :-
    compound(Term),
    !,
    mapargs(known_value(Names), Term, Result).
known_values(Term, _, Term).

known_value(Names, Term, Value) :-
    known_values(Term, Names, Value).

%   study_played(+Path, +Values, -Measures): a run of a study as a model of the
%   page, with these values of parameters.  Its log is kept under its name.  A run
%   that ends by its limit fails.

study_played(Path, Values, Measures) :-
    use_module(project('experiments/engine/live')),
    use_module(project('experiments/engine/studies')),
    study_load(project(Path), Study),
    study_at_work(Study),
    live(Study, about(_, Parameters)),
    findall(Name-Value, ( member(parameter(Name, First, _), Parameters),
                          value_of(Name, Values, First, Value) ),
            Pairs),
    setup_call_cleanup(live(Study, set_up(Pairs)),
                       run_of(Study, Path, Measures),
                       live(Study, end)).

value_of(Name, Values, First, Value) :-
    ( memberchk(Name-Value0, Values) -> Value = Value0 ; Value = First ).

run_of(Study, Path, Measures) :-
    catch(live(Study, run), error(study_goal_failed(run/2), _), true),
    live(Study, measures(Measures)),
    study_live:live(_, Events, _, _),
    file_base_name(Path, Name),
    atom_concat(Name, '.log', Log),
    copy_file(Events, Log).
