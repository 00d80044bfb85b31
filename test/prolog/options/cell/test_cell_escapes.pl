:- module(test_cell_escapes, []).
:- use_module('../../../lib/common').
:- needs([cells]).
:- use_module('../../../lib/cell_inmate').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2, subset/2]).
:- use_module(library(typhon)).

/** <module> Data that an agent with all rights inside its cell cannot reach

*Threading*: one test at a time.
*/

:- begin_tests(cell_escapes).

test(system_is_unreachable, Through == []) :-
    findall(Name-Goal-Expected, check(Name, Goal, Expected), Checks),
    with_inmates(through(Checks, Through)).
test(data_of_an_owner_is_not_in_the_cell_of_another,
     [Left,Seen] = [yes(_),yes(test_see(_, [no,no,no]))]) :-
    no_leaks(with_peers([p-[host([])]],
                        with_inmates(left_to_another(Left, Seen)))).

:- end_tests(cell_escapes).

%   An agent of this process leaves a fact in its cell, and an agent that was
%   created in the process p looks for it.

left_to_another(Left, Seen) :-
    Things = [ size_file('/tmp/services.pl', 4), current_predicate(left/0),
               tcp_connect('127.0.0.1':20001, _, []) ],
    attempt(( open('/tmp/services.pl', write, S), write(S, left), close(S),
              assertz(left),
              tcp_socket(T), tcp_bind(T, '127.0.0.1':20001), tcp_listen(T, 5),
              test_see(Things, [yes,yes,yes]) ), Left),
    address(c, C),
    inmate(move(C), test_see(Things, _), Clauses),
    peer_do(p, agent_create(clauses(Clauses), A)),
    agent_result(A, Seen, 30).

only_what_is_mounted(Names) :-
    current_prolog_flag(home, Home),
    atomic_list_concat(['',Top|_], /, Home),
    subset(Names, [Top,.,..,bin,dev,etc,lib,lib64,proc,tmp,typhon,usr]).

%   check(-Name, -Goal, -Expected)

check('descriptors', directory_files('/proc/self/fd', L),
      yes(directory_files(_, L), subset(L, [.,..,'0','1','2','3','4']))).
check('a shell',
      ( catch(shell('echo > /tmp/made'), _, true), exists_file('/tmp/made') ),
      no).
check('a process', process_create('/usr/bin/prlimit', [], []),
      raised(_)).
check('a fork', ( fork(Pid), Pid \== child ), raised(_)).
check('files of the system', open('/etc/passwd', read, _),
      raised(existence_error(_, _))).
check('a file of the gatekeeper', open(target(secret), read, _),
      raised(existence_error(_, _))).
check('what is in /', directory_files(/, L),
      yes(directory_files(_, L), only_what_is_mounted(L))).
check('to change the library', open('/typhon/x', write, _),
      raised(permission_error(_, _, _))).
check('to fill the disk',
      ( open('/tmp/services.pl', write, S),
        catch(forall(between(1, 40000, _), format(S, "~`xt~1000|~n", [])), E,
              true),
        close(S, [force(true)]), open('/tmp/services.pl', write, S1),
        close(S1), throw(E) ),
      raised(io_error(_, _))).
check('to make a file', open('/tmp/x', write, _),
      raised(permission_error(_, _, _))).
check('to make a folder', make_directory('/tmp/x'),
      raised(permission_error(_, _, _))).
check('to make files in place of others',
      ( delete_file('/tmp/policy'), open('/tmp/policy', write, _) ),
      raised(permission_error(_, _, _))).
check('a higher priority',
      ( open('/proc/self/autogroup', update, S), write(S, 0), close(S) ),
      raised(permission_error(_, _, _))).
check('shared memory', open('/dev/shm/x', write, _),
      raised(permission_error(_, _, _))).
check('a port of the host', tcp_connect('127.0.0.1':target(port), _, []),
      raised(socket_error(econnrefused, _))).
check('the internet', tcp_connect('192.0.2.1':80, _, []),
      raised(socket_error(enetunreach, _))).
check('a name server', tcp_host_to_address('example.org', _),
      raised(_)).
check('a Unix socket of the host',
      ( use_module(library(socket)), unix_domain_socket(S),
        tcp_connect(S, target(other)) ), raised(existence_error(file, _))).
check('other processes',
      ( directory_files('/proc', L),
        findall(N, ( member(X, L), atom_number(X, N) ), Ns) ),
      yes(( _, findall(_, _, Ns) ), ( length(Ns, C), C =< 2 ))).
check('process 1 is this one', current_prolog_flag(pid, P),
      yes(current_prolog_flag(_, P), P == 1)).
check('to kill the gatekeeper', process_kill(target(pid), kill),
      raised(_)).
check('memory of another process',
      open('/proc/2/mem', read, _), raised(_)).
check('the environment', environ(_),
      yes(environ(L), \+ memberchk('TYPHON_COOKIE'=_, L))).
check('a hundred threads',
      ( set_prolog_flag(threads, true),
        forall(between(1, 100, _),
               thread_create(sleep(2), _, [detached(true)])) ),
      raised(_) ; ended(_)).
check('more memory', rlimit(as, _, unlimited), raised(_)).
check('more processes', rlimit(nproc, _, 100000), raised(_)).
check('larger files', rlimit(fsize, _, unlimited), raised(_)).
check('to live for ever',
      ( open('/proc/self/oom_score_adj', write, S), write(S, '-1000'),
        close(S) ), raised(_)).
check('the kernel', open('/proc/sys/kernel/core_pattern', write, _),
      raised(_)).
check('users of the namespace',
      ( open('/proc/self/uid_map', write, S), write(S, '0 0 1\n'), close(S) ),
      raised(_)).
check('devices', open('/dev/kmsg', read, _),
      raised(existence_error(_, _))).
check('/sys', open('/sys/class/net', read, _),
      raised(existence_error(_, _))).
check('the root of process 1', open('/proc/1/root/etc/passwd', read, _),
      raised(existence_error(_, _))).
check('memory of the gatekeeper', test_open_of(target(pid), mem),
      raised(existence_error(_, _))).
check('the environment of the gatekeeper', test_open_of(target(pid), environ),
      raised(existence_error(_, _))).
check('memory of another cell', test_open_of(target(cell), mem),
      raised(existence_error(_, _))).
check('files of another cell', test_open_of(target(cell), 'root/tmp/policy'),
      raised(existence_error(_, _))).
check('to kill another cell', process_kill(target(cell), kill), raised(_)).
check('a link to a file of the system',
      ( link_file('/etc/shadow', '/tmp/link', symbolic),
        open('/tmp/link', read, _) ), raised(_)).
check('another name for the library',
      link_file('/typhon/typhon.pl', '/tmp/typhon.pl', hard), raised(_)).
check('to delete the library', delete_file('/typhon/typhon.pl'),
      raised(permission_error(_, _, _))).
check('to move the library', rename_file('/typhon/typhon.pl', '/tmp/x.pl'),
      raised(_)).
check('to change SWI-Prolog',
      ( current_prolog_flag(home, H), atom_concat(H, '/library/x.pl', F),
        open(F, write, _) ), raised(permission_error(_, _, _))).
check('to change programs', open('/usr/bin/prlimit', append, _),
      raised(permission_error(_, _, _))).
check('folders of users',
      ( ( Dir = '/root' ; Dir = '/home' ), exists_directory(Dir),
        current_prolog_flag(home, H), atom_concat(Dir, /, Begin),
        \+ sub_atom(H, 0, _, _, Begin) ), no).
check('files beside SWI-Prolog in the folder of a user',
      ( ( Begin = '/root/' ; Begin = '/home/' ),
        current_prolog_flag(home, H), sub_atom(H, 0, _, _, Begin),
        sub_atom(H, N, 1, _, /), N > 0, sub_atom(H, 0, N, _, Above),
        directory_files(Above, Files), \+ length(Files, 3) ), no).
check('another user', setuid(0), raised(_)).
check('another group', setgid(0), raised(_)).
check('a datagram to the internet',
      ( udp_socket(S), udp_send(S, "x", '192.0.2.1':53, []) ), raised(_)).
check('all machines of the network',
      ( udp_socket(S), udp_send(S, "x", '224.0.0.1':5353, []) ), raised(_)).
check('a file that can be run',
      chmod('/tmp/policy', +x), raised(_)).
check('to fill the disk with several files',
      ( length(L, 16000), maplist(=(0'a), L), string_codes(T, L),
        read_file_to_string('/tmp/policy', Policy, []),
        catch(forall(member(F, ['/tmp/services.pl','/tmp/policy']),
                     ( open(F, write, S),
                       forall(between(1, 1000, _), write(S, T)),
                       close(S) )), E, true),
        open('/tmp/services.pl', write, S1), close(S1),
        open('/tmp/policy', write, S2), write(S2, Policy), close(S2),
        throw(E) ),
      raised(io_error(_, _))).
check('memory of the kernel', open('/proc/kcore', read, _), raised(_)).
check('keys of the kernel', open('/proc/sysrq-trigger', write, _), raised(_)).
check('groups of the namespace',
      ( open('/proc/self/setgroups', write, S), write(S, allow), close(S) ),
      raised(_)).
check('all memory',
      ( set_prolog_flag(stack_limit, 16000000000), length(L, 200000000),
        L = [a|_] ), raised(resource_error(_)) ; ended(_)).
check('a program in its place',
      exec('/usr/bin/prlimit'('--as=unlimited', '--nproc=unlimited')),
      ended(lost(cell(exit(1))))).
check('a hundred files',
      forall(between(1, 100, _), open('/tmp/services.pl', append, _)),
      raised(resource_error(max_files))
      ; ended(raised(error(resource_error(max_files), _)))).
check('to end the process', halt, ended(lost(cell(exit(0))))).
