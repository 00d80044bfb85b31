:- module(test_load, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [numlist/3]).
:- use_module(library(yall)).
:- use_module(library(typhon)).

/** <module> Restore points are loaded on a chosen host

*Threading*: one test at a time.
*/

%   saved(-File, :Goal): File is the restore point of an agent that reports its
%   host when it receives `go`.

:- meta_predicate saved(-, 0).

saved(File, Goal) :-
    with_tmp_dir(save(File, Goal)).

save(File, Goal, Dir) :-
    directory_file_path(Dir, point, File),
    with_hosts([alpha],
               ( create([ (main :- receive(_-go), here(H), leave(was(H))) ],
                        A),
                 wait_state(A, waiting),
                 agent_save(A, File) )),
    call(Goal).

:- begin_tests(load).

test(loaded_on_a_host_of_this_process, true(Was == Gamma)) :-
    saved(File,
          with_hosts([beta,gamma],
                     ( address(gamma, Gamma),
                       agent_load(File, A, [host(gamma)]),
                       agent_property(A, home(Gamma)),
                       agent_send(A, go),
                       joined(A, done),
                       remote(gamma, sense(was(Was))) ))).
test(loaded_on_the_first_host_by_default, true(H == Beta)) :-
    saved(File,
          with_hosts([beta,gamma],
                     ( address(beta, Beta),
                       agent_load(File, A, []),
                       agent_property(A, host(H)) ))).
test(loaded_in_another_process, true(Was == Far)) :-
    saved(File,
          with_hosts([beta],
                     with_peers([far],
                                ( peer_host(far, Far),
                                  agent_load(File, A, [host(Far)]),
                                  agent_send(A, go),
                                  joined(A, done),
                                  remote(Far, sense(was(Was))) )))).
test(no_such_host, error(existence_error(host, nowhere))) :-
    saved(File, with_hosts([beta], agent_load(File, _, [host(nowhere)]))).
test(full, error(move_refused(_, capacity))) :-
    saved(File, with_hosts([beta-[capacity(0)]],
                           agent_load(File, _, [host(beta)]))).
test(unknown_option, error(domain_error(load_option, name(x)))) :-
    saved(File, with_hosts([beta], agent_load(File, _, [name(x)]))).
test(invalid_host_name, error(type_error(atom, 7))) :-
    saved(File, with_hosts([beta], agent_load(File, _, [host(7)]))).

%   The portray goal of write_term/3 would abort the process.

test(program_too_deep_to_be_read_back,
     true(E-H == resource_error(c_stack)-Alpha)) :-
    with_tmp_dir(plunit_load:deep(E, H, Alpha)).

deep(Formal, H, Alpha, Dir) :-
    directory_file_path(Dir, point, File),
    with_hosts([alpha],
               ( address(alpha, Alpha),
                 create([on_message(_, _)], A),
                 agent_save(A, File),
                 create([ (main :- receive(_-go)) ], B),
                 wait_state(B, waiting),
                 numlist(1, 100 000, Numbers),
                 foldl([_,T,s(T)]>>true, Numbers, z, Deep),
                 agent_send(B, Deep),
                 catch(agent_save(B, File), error(Formal, _), true),
                 agent_load(File, Former),
                 agent_property(Former, host(H)) )).

:- end_tests(load).
