:- module(test_place, []).

% Files in the place of a host that change while agents are there.

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [directory_file_path/3, set_time_file/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(make), [make/0]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

%   write_place(+Dir, +Name, +Age, +Text, -File): the file was changed Age
%   seconds ago.

write_place(Dir, Name, Age, Text, File) :-
    directory_file_path(Dir, Name, File),
    write_file(File, Text),
    get_time(Now),
    Then is Now-Age,
    set_time_file(File, _, [modified(Then)]).

made(Messages) :-
    capturing(make, Messages).

said(Agent, Colour) :-
    agent_send(Agent, look),
    wait_until(fact_of(Agent, s(Colour)), 10).

:- begin_tests(place_make).

test(running_agents_see_changed_files) :-
    with_tmp_dir(changes).

changes(Dir) :-
    write_place(Dir, 'p.pl', 100, ':- include(more).\ncolour(red).\nshape(1).\n',
                File),
    write_place(Dir, 'more.pl', 100, 'size(1).\n', _),
    with_hosts([alpha-[consult(File)], beta-[consult(File)]],
               changes(Dir, File)).

changes(Dir, File) :-
    create([(on_message(_, look) :- colour(C), assertz(s(C)))], Agent,
           [host(alpha)]),
    said(Agent, red),
    made(None),
    assertion(\+ member(_-typhon(place_reloaded(_, _)), None)),
    remote(alpha, leave(tuple)),
    write_place(Dir, 'p.pl', 50, ':- include(more).\ncolour(blue).\n', _),
    made(Messages),
    findall(Place, member(informational-typhon(place_reloaded(Place, File)),
                          Messages),
            Places),
    assertion(length(Places, 2)),
    said(Agent, blue),
    forall(member(Host, [alpha, beta]),
           ( assertion(remote(Host, findall(C, colour(C), [blue]))),
             assertion(\+ remote(Host, catch(shape(_), _, fail))) )),
    assertion(remote(alpha, sense(tuple))),
    write_place(Dir, 'more.pl', 20, 'size(2).\n', _),
    made(_),
    assertion(remote(beta, findall(S, size(S), [2]))).

%   Errors in a file are reported; the place is kept, and is made again when
%   the file is corrected.

test(errors_are_reported) :-
    with_tmp_dir(mistakes).

mistakes(Dir) :-
    write_place(Dir, 'p.pl', 100, 'colour(red).\n', File),
    with_hosts([alpha-[consult(File)]], mistakes(Dir, File)).

mistakes(Dir, _) :-
    write_place(Dir, 'p.pl', 50, 'colour(blue).\ncolour(green.\n', _),
    made(Messages),
    assertion(member(error-error(syntax_error(_), _), Messages)),
    assertion(remote(alpha, findall(C, colour(C), [blue]))),
    write_place(Dir, 'p.pl', 20, 'colour(green).\n', _),
    made(_),
    assertion(remote(alpha, findall(C, colour(C), [green]))).

%   An agent keeps the program with which it was created; an agent that is
%   created later has the new one, without make/0.

test(agents_keep_the_program_of_their_creation) :-
    with_tmp_dir(programs).

programs(Dir) :-
    program(Dir, 100, old, File),
    with_hosts([alpha], programs(Dir, File)).

programs(Dir, File) :-
    agent_create(File, A),
    program(Dir, 50, new, File),
    made(_),
    agent_create(File, B),
    forall(member(Agent-Version, [A-old, B-new]),
           said(Agent, Version)).

program(Dir, Age, Version, File) :-
    format(atom(Text), ':- agent(p, [state([s/1])]).~n\c
                        on_message(_, look) :- version(V), assertz(s(V)).~n\c
                        version(~w).~n', [Version]),
    write_place(Dir, 'program.pl', Age, Text, File).

:- end_tests(place_make).

:- begin_tests(place_constraints).

test(constraints_last_until_the_agent_stops, Counts == [1,0,1,0]) :-
    with_tmp_dir(constraints(Counts)).

constraints(Counts, Dir) :-
    write_place(Dir, 'leq.pl', 100,
                ':- use_module(library(chr)).\n\c
                 :- chr_constraint leq(?any,?any).\n\c
                 leq(X,Y), leq(Y,X) <=> X = Y.\n\c
                 leq(X,Y), leq(Y,Z) ==> leq(X,Z).\n\c
                 stored(N) :- findall(x, \'$enumerate_constraints\'(_), L),\n\c
                              length(L, N).\n',
                File),
    with_hosts([alpha-[consult(File)], beta-[consult(File)]],
               ( solved(alpha, Counts), solved(beta, Counts) )).

%   Two agents, one after the other, in each worker.

solved(Host, Counts) :-
    assertion(remote(Host, ( leq(A, B), leq(B, C), leq(C, A),
                             A == B, B == C ))),
    findall(Agent,
            ( between(1, 8, _),
              create([ (main :- leq(A1, B1), leq(B1, A1), A1 == B1,
                                leq(a, b), stored(N1), sleep(0), stored(N2),
                                leq(c, d), stored(N3), sleep(0), stored(N4),
                                result([N1,N2,N3,N4])) ], Agent,
                     [host(Host)]) ),
            Agents),
    findall(Result, ( member(Agent, Agents),
                      agent_result(Agent, Result, 20) ), Results),
    sort(Results, [Counts]).

:- end_tests(place_constraints).
