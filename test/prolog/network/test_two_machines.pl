:- module(test_two_machines, []).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/3]).
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(yall)).

/** <module> Two machines, simulated by two network namespaces

Made and removed by the suite, with addresses of their own on a cable of
their own: 10.213.77.1 and 10.213.77.2. Needs root and `ip`; skipped with a
message where that is not permitted.
*/

here('10.213.77.1').
there('10.213.77.2').

space(Which, Space) :-
    current_prolog_flag(pid, Pid),
    format(atom(Space), 'typhon~w~d', [Which, Pid]).

cable(Which, Cable) :-
    current_prolog_flag(pid, Pid),
    Short is Pid mod 1000000,
    format(atom(Cable), 'ty~w~d', [Which, Short]).

                /*******************************
                *          NAMESPACES          *
                *******************************/

ip(Args) :-
    ip(Args, exit(0)).

ip(Args, Status) :-
    process_create(path(ip), Args,
                   [stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, Status).

permitted :-
    catch(( connect, disconnect ), error(_, _), fail),
    !.
permitted :-
    disconnect,
    format(user_error, "% two machines: skipped, network namespaces are \c
                        not permitted here~n", []),
    fail.

connect :-
    space(a, A),
    space(b, B),
    cable(a, CableA),
    cable(b, CableB),
    here(Here),
    there(There),
    ip([netns, add, A]),
    ip([netns, add, B]),
    ip([link, add, CableA, netns, A, type, veth, peer, name, CableB,
        netns, B]),
    maplist(up, [A-CableA-Here, B-CableB-There]).

up(Space-Cable-Address) :-
    atom_concat(Address, '/24', Net),
    ip(['-n', Space, addr, add, Net, dev, Cable]),
    ip(['-n', Space, link, set, Cable, up]),
    ip(['-n', Space, link, set, lo, up]).

disconnect :-
    space(a, A),
    space(b, B),
    catch(maplist([S]>>ip([netns, delete, S], _), [A, B]), error(_, _), true).

%   in_space(+Which, +Goal, +Environment, :Then): call(Then, In, Out) while
%   a process runs Goal.

:- meta_predicate in_space(+, +, +, 2).

in_space(Which, Goal, Environment, Then) :-
    space(Which, Space),
    current_prolog_flag(executable, Swipl),
    project_file('test/lib/two_machines.pl', File),
    format(atom(Text), '~q', [Goal]),
    setup_call_cleanup(
        process_create(path(ip),
                       [ netns, exec, Space, Swipl, '-f', none, '-g', Text,
                         '-t', halt, File ],
                       [ stdin(pipe(In)), stdout(pipe(Out)), process(Pid),
                         environment(Environment) ]),
        once(call(Then, In, Out)),
        ( close(In, [force(true)]),
          close(Out, [force(true)]),
          wait_for_end(Pid, 20, _) )).

line(Out, Term) :-
    read_line_to_string(Out, Line),
    Line \== end_of_file,
    term_string(Term, Line).

:- begin_tests(two_machines,
               [ condition(permitted), setup(connect), cleanup(disconnect) ]).

test(network_over_two_addresses,
     Said == network([Here, Here, Here, There, There, There], done, 6)) :-
    here(Here),
    there(There),
    with_tmp_dir(over(Here, There, Said)).

over(Here, There, Said, Dir) :-
    directory_file_path(Dir, rsh, Rsh),
    space(b, Space),
    write_file(Rsh, "#!/bin/sh~nshift~nexec ip netns exec ~w sh -c \"$*\"~n",
               [Space]),
    process_create(path(chmod), ['+x', file(Rsh)], []),
    in_space(a, network_over(Here, There, Rsh), [], said(Said)).

said(Said, _, Out) :-
    line(Out, Said).

test(hosts_with_a_shared_cookie, Said == visited(done, Far)) :-
    shared('TYPHON_COOKIE'=one, 'TYPHON_COOKIE'=one, Said, Far).
test(hosts_with_different_cookies,
     true(subsumes_term(permission_error(authenticate, host, _), Formal))) :-
    shared('TYPHON_COOKIE'=one, 'TYPHON_COOKIE'=other, Said, _),
    Said = error(Formal).

shared(CookieA, CookieB, Said, Far) :-
    here(Here),
    there(There),
    in_space(b, host_at(far, There), [CookieB],
             visited(Here, CookieA, Said, Far)).

visited(Here, Cookie, Said, Far, _, Out) :-
    line(Out, Far),
    in_space(a, visit(Here, Far), [Cookie], said(Said)).

:- end_tests(two_machines).
