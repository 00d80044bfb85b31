:- module(test_imports, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, link_file/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(yall)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program), [program_read/7]).

/** <module> A host loads no library for a program that it refuses

The libraries here raise a flag when they are loaded.  The folder of libraries
has free.pl, in/deep.pl, and links to files outside of it; evil.pl is beside the
folder.

*Threading*: one test at a time.
*/

:- dynamic folder/1.

:- meta_predicate with_libraries(0).

with_libraries(Goal) :-
    with_tmp_dir(test_imports:in_folder(Goal)).

in_folder(Goal, Dir) :-
    maplist(directory_file_path(Dir), [evil, lib, out], [Evil, Lib, Out]),
    maplist(make_directory, [Lib, Out]),
    maplist(directory_file_path(Lib), [free, in, link, linked],
            [Free, In, Link, Linked]),
    make_directory(In),
    directory_file_path(In, deep, Deep),
    directory_file_path(Out, evil, OutEvil),
    maplist(library_written, [Evil, Free, Deep, OutEvil]),
    atom_concat(Link, '.pl', LinkFile),
    link_file('../evil.pl', LinkFile, symbolic),
    link_file('../out', Linked, symbolic),
    setup_call_cleanup(
        ( asserta(user:file_search_path(library, Lib), Ref),
          assertz(folder(Dir)), flag(typhon_imports, _, 0) ),
        once(Goal),
        ( erase(Ref), retractall(folder(_)), unloaded(Dir) )).

%   Each is a module of its own, with an operator.

library_written(Path) :-
    atom_concat(Path, '.pl', File),
    write_file(File, ':- module(~q, [given/1, op(700, xfx, ===>)]).~n\c
                      :- flag(typhon_imports, N, N+1).~n\c
                      given(free).~n', [Path]).

unloaded(Dir) :-
    forall(( source_file(File), sub_atom(File, 0, _, _, Dir) ),
           unload_file(File)).

loads(Count) :-
    flag(typhon_imports, Count, Count).

%   path(-Spec): no name of a library.

path(library(Name)) :-
    member(Name,
           [ '../evil', ('..')/evil, in/('..')/free, 'in/../../evil',
             'in/deep', './free', 'free.pl', ('.')/free, '~/evil',
             '$HOME/evil', '*', "free", free(x), '', [] ]).
path(library(File)) :-
    folder(Dir),
    directory_file_path(Dir, evil, File).

%   elsewhere(-Spec): no library at all.

elsewhere(agents('../lib/free')).
elsewhere(payloads(free)).
elsewhere(swi(library/lists)).
elsewhere('lib/free').
elsewhere(File) :-
    folder(Dir),
    directory_file_path(Dir, evil, File).

linked(library(link)).
linked(library(linked/evil)).

attack(Spec) :- path(Spec).
attack(Spec) :- elsewhere(Spec).
attack(Spec) :- linked(Spec).
attack(library(free)).
attack(library(in/deep)).
attack(library(www_browser)).

terms(Spec, [(:- agent(b, [])), (:- use_module(Spec)), main]).
terms(Spec, [(:- agent(b, [])), (:- use_module(Spec, [given/1])), main]).

program(Spec, program(b, [], [Spec-all], [(main :- true)])).
program(Spec, program(b, [], [Spec-[given/1]], [(main :- true)])).

outcome(Goal, Outcome) :-
    catch(( call(Goal), Outcome = true ), error(Outcome, _), true).

:- begin_tests(refused_programs).

%   The attacker is an agent on the host.

test(created_by_an_untrusted_agent, Loads == 0) :-
    with_libraries(
        with_hosts([g-[policy(guarded), cell(none)]],
                   ( forall(( attack(Spec), terms(Spec, Terms) ),
                            creates(Terms)),
                     loads(Loads) ))),
    assertion(\+ was_loaded(www_browser)).

creates(Terms) :-
    create([ (main :- catch(create(clauses(Terms), _, []), error(E, _), true),
                      result(raised(E))) ], A, [host(g)]),
    agent_result(A, Result, 20),
    assertion((Terms-Result) = (_-raised(E))),
    Result = raised(E),
    assertion(nonvar(E)).

%   The attacker is a process that knows the cookie.

test(sent_by_a_peer, Loads == 0) :-
    with_libraries(no_leaks(with_peers([far], from_peer(Loads)))).

from_peer(Loads) :-
    setup_call_cleanup(
        host_start(g, [policy(guarded), cell(none)]),
        ( create([on_message(_, _)], A, [host(g)]),
          forall(( attack(Spec), program(Spec, Program), sends(Way) ),
                 ( sent(Way, Program, A, Answer),
                   assertion(refuses(Answer)) )),
          loads(Loads) ),
        host_stop(g)).

sends(hop).
sends(create).
sends(change).

sent(Way, Program, Agent, Answer) :-
    typhon_code:program_hash(Program, Hash),
    typhon_agents:make_life(inf, [], [], false, Life),
    request(Way, Program, Hash, Life, Agent, Kind, Request),
    host_property(g, address(Address)),
    typhon_host:address_parts(Address, _, Endpoint),
    peer_do(far, typhon_wire:endpoint_call(Endpoint, Kind, Request, Answer,
                                           20)).

request(hop, Program, Hash, Life, _, hop,
        hop(g, image('x.1.0@far@127.0.0.1:1', Hash, Life, state([], []),
                     true-[], [], 0.0), Program)).
request(create, Program, Hash, Life, _, agent,
        create(g, x, start(Hash, Life, state([], []), [], []), Program)).
request(change, Program, Hash, _, Agent, agent,
        question(Agent, order(change(program(Hash, Program))))).

refuses(answer(refused(_))).
refuses(answer(error(_))).

%   The attacker has written a restore point.

test(restored, Loads == 0) :-
    with_libraries(
        with_hosts([g-[policy(guarded), cell(none)]],
                   ( forall(( attack(Spec), program(Spec, Program) ),
                            restored(Program)),
                     loads(Loads) ))).

restored(Program) :-
    folder(Dir),
    directory_file_path(Dir, point, File),
    typhon_agents:make_life(inf, [], [], false, Life),
    typhon_restore:restore_point(File, image(x, Program, Life, state([], []),
                                             [], [])),
    outcome(agent_load(File, _, [host(g)]), Outcome),
    assertion(Outcome \== true).

%   A trusted host refuses for other reasons.

test(refused_by_a_trusted_host, Loads == 0) :-
    with_libraries(
        with_hosts([t-[tokens([red])], full-[capacity(0)]],
                   ( terms(library(free), Terms),
                     forall(member(Host-Reason, [t-token, full-capacity]),
                            ( outcome(agent_create(clauses(Terms), _,
                                                   [host(Host)]),
                                      Outcome),
                              assertion(subsumes_term(
                                            move_refused(_, Reason),
                                            Outcome)) )),
                     loads(Loads) ))).

%   The clauses call predicates that Prolog would autoload.

test(analysis_loads_nothing, New == []) :-
    findall(File, source_file(File), Before),
    Goals = [ www_open_url(x), xref_source(x), x:qsave_program(x),
              threads ],
    forall(( member(Goal, Goals),
             member(Body, [Goal, \+ Goal, findall(x, Goal, _)]) ),
           with_hosts([g-[policy(guarded), cell(none)]],
                      outcome(agent_create(clauses([ (:- agent(b, [])),
                                                     (main :- Body) ]), _,
                                           [host(g)]), _))),
    findall(File, ( source_file(File), \+ memberchk(File, Before),
                    names(File) ), New).

%   To print a clause Prolog looks up its goals.

test(listing_loads_nothing, New == []) :-
    with_hosts([g-[policy(guarded), cell(none)]],
               ( create([ (on_message(_, _) :- s(www), unheard(1)),
                          (unheard(X) :- X > 1, \+ s(X)) ], A,
                        [host(g)]),
                 findall(File, source_file(File), Before),
                 with_output_to(string(_), agent_listing(A)),
                 with_output_to(string(_),
                                typhon_text:print_clause(
                                    current_output, (a :- www_open_url(x)),
                                    [])),
                 findall(File, ( source_file(File),
                                 \+ memberchk(File, Before), names(File) ),
                         New) )).

names(File) :-
    member(Name, [www_browser, prolog_xref, prolog_debug, qsave, threadutil]),
    file_base_name(File, Base),
    file_name_extension(Name, _, Base).

was_loaded(Name) :-
    source_file(File),
    file_base_name(File, Base),
    file_name_extension(Name, _, Base),
    !.

:- end_tests(refused_programs).

:- begin_tests(imports).

test(paths_are_no_libraries) :-
    with_libraries(
        with_hosts([t],
                   forall(( path(Spec), terms(Spec, Terms) ),
                          ( outcome(agent_create(clauses(Terms), _, []), F),
                            assertion(F == domain_error(library_name, Spec))
                          )))).
test(other_aliases_are_no_libraries) :-
    with_libraries(
        with_hosts([t],
                   forall(( elsewhere(Spec), terms(Spec, Terms) ),
                          ( outcome(agent_create(clauses(Terms), _, []), F),
                            assertion(subsumes_term(domain_error(directive, _),
                                                    F)) )))).
test(links_are_no_libraries, Loads == 0) :-
    with_libraries(
        with_hosts([t],
                   ( forall(( linked(Spec), terms(Spec, Terms) ),
                            ( Spec = library(Name),
                              outcome(agent_create(clauses(Terms), _, []), F),
                              assertion(F == permission_error(import, library,
                                                              Name)) )),
                     loads(Loads) ))).
test(paths_of_peers_are_refused, Loads == 0) :-
    with_libraries(
        with_hosts([t],
                   ( forall(( ( path(Spec) ; elsewhere(Spec) ; linked(Spec) ),
                              program(Spec, Program) ),
                            arrives(Program)),
                     loads(Loads) ))).

arrives(Program) :-
    typhon_code:program_hash(Program, Hash),
    typhon_agents:make_life(inf, [], [], false, Life),
    outcome(typhon_gate:gate(t, from('127.0.0.1:1', Program, newborn)
                                - entrant(x, Hash, Life, state([], []), []),
                             =(ok), _), Outcome),
    assertion(memberchk(Outcome, [ domain_error(program_of_hash(_), _),
                                   permission_error(import, library, _) ])).

test(libraries_are_loaded_after_admission, Loads-R == 2-[free,free]) :-
    with_libraries(
        with_hosts([t],
                   ( maplist(result_of, [library(free), library(in/deep)], R),
                     loads(Loads) ))).

result_of(Spec, Result) :-
    create([(:- use_module(Spec)), (main :- given(X), result(X))], A, []),
    agent_result(A, Result, 20).

test(reading_loads_nothing, Loads-Op == 0-'===>'(a, b)) :-
    with_libraries(( read_with_operator(Op), loads(Loads) )).

read_with_operator(Op) :-
    folder(Dir),
    directory_file_path(Dir, 'agent.pl', File),
    write_file(File, ':- agent(a).~n:- use_module(library(free)).~nmain.~n\c
                      a ===> b.~nsee(X) :- given(X).~n', []),
    program_read(File, program(_, _, _, Clauses), _, _, _, _, _),
    append(_, [Op,_], Clauses),
    capturing(agent_check(File), Messages),
    assertion(Messages = [informational-_]).

%   Property: names are accepted exactly if they are made of name characters.

test(random_names, Wrong == []) :-
    findall(Path, ( between(1, 500, _), random_path(Path, Good),
                    Import = library(Path)-all,
                    ( typhon_libraries:is_import(Import) -> Good == false
                    ; Good == true ) ),
            Wrong).

random_path(Path, Good) :-
    random_between(1, 3, Count),
    findall(Name-G, ( between(1, Count, _), random_name(Name, G) ),
            [First-Good0|Rest]),
    foldl(longer, Rest, First-Good0, Path-Good).

longer(Name-Good, Path0-Good0, (Path0/Name)-Both) :-
    ( Good == true, Good0 == true -> Both = true ; Both = false ).

random_name(Name, Good) :-
    random_between(1, 5, Length),
    length(Chars, Length),
    maplist([C]>>random_member(C, [a,b,'_',-,'1',z,'Q']), Chars),
    (   random_between(0, 2, 0)
    ->  random_member(Bad, ['.', /, '\\', '~', $, ' ', '\u0000', :, *, '{']),
        append(Chars, [Bad], All),
        Good = false
    ;   All = Chars,
        Good = true
    ),
    atom_chars(Name, All).

:- end_tests(imports).
