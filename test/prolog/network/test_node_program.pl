:- module(test_node_program, []).

% Child processes start from a saved state if there are many of them. This suite
% runs without the saved state of the other suites.

:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

%   A script that runs in a copy of the library.  networks(Counts) prints
%   for each network of so many processes the state that each of its children
%   runs, or `none`, and what an agent counts that visits all hosts.

script("
:- prolog_load_context(directory, Dir),
   atom_concat(Dir, '/prolog', Library),
   asserta(user:file_search_path(library, Library)).
:- use_module(library(typhon)).
:- use_module(library(process)).
:- use_module(library(readutil)).

networks(Counts) :-
    forall(member(Count, Counts), network(Count)).

network(Count) :-
    setup_call_cleanup(
        network_start(ring(Count), Network, [processes(Count)]),
        ( network_property(Network, processes(Pids)),
          findall(State, ( member(Pid, Pids), state(Pid, State) ), States0),
          sort(States0, States),
          network_property(Network, hosts([Host|Hosts])),
          agent_create(clauses([ (:- agent(visitor)), (:- dynamic route/1),
                                 (main :- route(L), length(L, N), visit(L, N)),
                                 (visit([], N) :- result(N)),
                                 (visit([H|Hs], N) :- move(H), visit(Hs, N)) ]),
                       Agent, [host(Host), facts([route(Hosts)])]),
          agent_result(Agent, Visited, 60),
          format('~q.~n', [network(Count, States, Visited)]) ),
        network_stop(Network)).

state(Pid, State) :-
    format(atom(File), '/proc/~w/cmdline', [Pid]),
    read_file_to_string(File, Text, []),
    split_string(Text, \"\\0\", \"\", Words),
    (   append(_, [\"-x\", State0|_], Words)
    ->  atom_string(State, State0)
    ;   State = none
    ).

no_directory :-
    tmp_file(gone, Dir),
    make_directory(Dir),
    set_prolog_flag(tmp_dir, Dir),
    delete_directory(Dir).

changed :-
    module_property(typhon_hosts, file(File)),
    get_time(Now),
    Later is Now+1,
    set_time_file(File, [], [modified(Later)]).
").

%   said(+Goal, -Terms): what a script prints that calls Goal.

said(Goal, Terms) :-
    with_tmp_dir(said(Goal, Terms)).

:- public said/3.

said(Goal, Terms, Dir) :-
    project_file(prolog, Prolog),
    process_create(path(cp), ['-r', Prolog, Dir], []),
    script(Script),
    directory_file_path(Dir, 'script.pl', File),
    write_file(File, '~w', [Script]),
    format(atom(Text), '~q', [Goal]),
    run_swipl(['-g', Text, '-t', halt, File], [], Status, Out, _),
    assertion(Status == exit(0)),
    setup_call_cleanup(open_string(Out, In), read_all(In, Terms), close(In)).

read_all(In, Terms) :-
    read_term(In, Term, []),
    (   Term == end_of_file
    ->  Terms = []
    ;   Terms = [Term|More],
        read_all(In, More)
    ).

:- begin_tests(node_program).

test(many_children_run_a_state_of_the_library_that_is_gone_after_halt) :-
    said(( networks([2,5,2]), changed, networks([5]) ), Terms),
    assertion(Terms = [ network(2, [none], 1), network(5, [_], 4),
                        network(2, [_], 1), network(5, [_], 4) ]),
    Terms = [ _, network(_, [State], _), network(_, [State1], _),
              network(_, [State2], _) ],
    assertion(State == State1),
    assertion(State \== none),
    assertion(State2 \== State),
    assertion(\+ exists_file(State)),
    assertion(\+ exists_file(State2)).

test(children_run_the_source_if_no_state_can_be_made) :-
    said(( no_directory, networks([5]) ), Terms),
    assertion(Terms == [network(5, [none], 4)]).

:- end_tests(node_program).
