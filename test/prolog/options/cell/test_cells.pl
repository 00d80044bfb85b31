:- module(test_cells, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- needs([cells]).
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/process_stat', [process_nice/2]).
:- use_module(library(plunit)).
:- use_module(library(filesex), [chmod/2, directory_file_path/3]).
:- use_module(library(lists),
              [member/2, numlist/3, subtract/3, sum_list/2]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3, read_file_to_terms/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/bridges/common), [service_begin/5]).
:- use_module(library(typhon/kernel/program), [vocabulary_word/2]).
:- use_module(library(typhon/options/cell/cell_frames), [cell_word/2]).
:- use_module(library(typhon/options/cell), [cells_list/1]).

/** <module> Agents in cells

*Threading*: one test at a time.
*/

%   cell(+Goal): Goal is called while the host c has agents in cells. These get
%   little processor time if other processes want it, and the default quota is
%   5 seconds of real time.

:- meta_predicate cell(0).

cell(Goal) :-
    with_hosts([c-[policy(guarded), cell(owner), quota([seconds(60)])]], Goal).

result(Clauses, Result) :-
    create(Clauses, A, [host(c)]),
    agent_result(A, Result, 120).

outcome(Clauses, Outcome) :-
    create(Clauses, A, [host(c)]),
    agent_join(A, Outcome, 120).

:- begin_tests(cells).

test(agent_in_a_cell_uses_the_vocabulary,
     Result = r(Id, C, C, 0, [C], [f(1),f(2)], 2, f(1), got(Id, clone))) :-
    cell(( address(c, C),
           result([ (main :- self(Me), here(H), home(B), hops(N),
                             neighbours(Ns), leave(f(1)), leave(f(2)),
                             findall(F, sense(F), Fs), host_load(_),
                             assertz(s(1)), sleep(0.01), assertz(s(2)),
                             aggregate_all(count, s(_), Seen),
                             take(f(X)), clone(Branch), talk(Branch, M),
                             result(r(Me, H, B, N, [H|Ns], Fs, Seen, f(X), M))),
                    (talk(parent(_), got(Me, M)) :- self(Me), receive(_-M)),
                    (talk(clone(P), _) :- send(P, clone), dispose) ], Result),
           arg(1, Result, Id) )).
test(parent_is_known, Parent == Id) :-
    cell(( create([ (main :- clone(Branch), tell(Branch)),
                    (tell(parent(C)) :- send(C, above), receive(_-P), result(P)),
                    (tell(clone(P)) :- receive(_-above), parent(Q), send(P, Q)) ],
                  Id, [host(c)]),
           agent_result(Id, Parent, 30) )).
test(gatekeeper_does_not_compile_the_program, Result-Modules == [a-[]]-[]) :-
    cell(( result([ (:- use_module(library(ugraphs))),
                    (main :- vertices_edges_to_ugraph([a], [], G),
                             result(G)) ], Result),
           findall(M, typhon_code:code_compiled(_, M), Modules) )).
test(imports_of_a_created_agent_are_not_loaded, Reason-Files ==
         policy((:- use_module(library(www_browser))))-[]) :-
    cell(( result([ (main :- catch(create(clauses(
                                              [ (:- agent(b, [])),
                                                (:- use_module(
                                                    library(www_browser))),
                                                main ]), _, []),
                                   error(move_refused(_, R), _), true),
                             result(R)) ], Reason),
           findall(File, ( source_file(File),
                           file_base_name(File, 'www_browser.pl') ),
                   Files) )).
test(messages_are_handled, Said == [hello(1),hello(2)]) :-
    cell(( create([ (:- dynamic(said/1)),
                    (on_message(_, hello(N)) :- assertz(said(hello(N)))),
                    (on_message(From, tell) :- findall(S, said(S), Ss),
                                               send(From, Ss)) ],
                  A, [host(c)]),
           agent_send(A, hello(1)), agent_send(A, hello(2)),
           result([ (main :- receive(_-ask(B)), send(B, tell), receive(_-Ss),
                             result(Ss)) ], A, Said) )).
test(unacknowledged_acts_keep_their_order, Said-Sensed == Ns-done) :-
    numlist(1, 1200, Ns),
    cell(( result([ (main :- self(Me), leave(begun),
                             forall(between(1, 1200, N), send(Me, N)),
                             take(begun), all(1200, Ms), result(Ms)),
                    all(0, []),
                    (all(N, [M|Ms]) :- N > 0, receive(_-M), N1 is N-1,
                                       all(N1, Ms)) ], Said),
           outcome([(main :- leave(a), sense(a), log(a), take(a))], Sensed) )).
test(pending_acts_are_done_before_the_agent_stops, Heard == slow) :-
    cell(( create([(main :- receive(_-M), result(M))], A, [host(c)]),
           create([ a(A), (main :- a(A), send(A, slow), sleep(60)) ], _,
                  [host(c)]),
           agent_result(A, Heard, 30) )).
test(quota_ends_an_agent_that_only_sends,
     Outcome = raised(error(resource_error(messages), _))) :-
    with_hosts([c-[policy(guarded), cell(owner), quota([messages(5)])]],
               outcome([(main :- self(Me), repeat,
                                 catch(send(Me, x), _, true), fail)],
                       Outcome)).
test(visible_errors_are_raised_at_once,
     Formals == [type_error(callable, 1),
                 permission_error(call, sandboxed, send(fipa(x), y))]) :-
    cell(result([ (main :- findall(F, ( act(G), catch(G, error(F, _), true) ),
                                   Fs), result(Fs)),
                  act(leave(1)), act(send(fipa(x), y)) ], Formals)).
test(agents_are_created_and_monitored, Down-Cells == done-1) :-
    cell(( result([(main :- create(clauses([(:- agent(b, [])),
                                            (main :- receive(_-end))]), B, []),
                            monitor(B), send(B, end),
                            receive(system-down(B, Outcome)),
                            result(Outcome))], Down),
           used_cells(Cells) )).
test(rules_apply_in_the_cell,
     Formal == permission_error(call, sandboxed, shell(ls))) :-
    cell(result([ plan(shell(ls)),
                  (main :- plan(G), catch(call(G), error(F, _), true),
                           result(F)) ], Formal)).
test(rules_refuse_at_admission,
     error(move_refused(_, policy(shell(ls))))) :-
    cell(create([(main :- shell(ls))], _, [host(c)])).
test(faults_have_their_location,
     Outcome-Place = raised(error(instantiation_error, _))-(foo/1:1)) :-
    cell(( create([ (main :- foo(X), result(X)),
                    (foo(X) :- atom_length(_, X)) ], A, [host(c)]),
           agent_join(A, Outcome, 120),
           agent_property(A, fault(fault(_, _, Place, _))) )).
test(failing_goal, Outcome == failed) :-
    cell(outcome([(main :- member(x, [y]))], Outcome)).
test(state_is_changed_from_outside, Facts == [n(1),n(2)]) :-
    cell(( create([ (:- dynamic(n/1)), n(1),
                    (main :- receive(_-go), findall(n(N), n(N), Ns),
                             result(Ns)) ], A, [host(c)]),
           wait_state(A, waiting),
           agent_change(A, facts([n(2)])),
           agent_send(A, go),
           agent_result(A, Facts, 30) )).
test(services_of_the_place_are_available, Result == [2,4]-no) :-
    with_tmp_dir(served(Result)).
test(cells_have_low_priority,
     [condition(exists_file('/proc/self/autogroup')),
      true(Session-Process == "10"-Low)]) :-
    process_nice(self, Own),
    Low is min(19, Own+10),
    cell(( create([(main :- receive(_))], A, [host(c)]),
           wait_state(A, waiting),
           cell_session_nice(Session),
           cell_nice(Process) )).
test(order_from_outside, Outcome == disposed) :-
    cell(( create([(main :- receive(_))], A, [host(c)]),
           wait_state(A, waiting),
           agent_dispose(A),
           agent_join(A, Outcome, 120) )).
test(agent_that_does_not_stop_is_ended,
     Outcomes-Beside = [raised(error(resource_error(seconds), _)),disposed]
                       -done) :-
    with_hosts([ c-[policy(guarded), cell(owner), quota([seconds(1)])] ],
               ( create([(main :- repeat, fail)], A, [host(c)]),
                 agent_join(A, Outcome1, 30),
                 create([(main :- repeat, fail)], B, [host(c)]),
                 wait_state(B, running),
                 agent_dispose(B, [force(0.1)]),
                 agent_join(B, Outcome2, 30),
                 outcome([(main :- sleep(0))], Beside),
                 Outcomes = [Outcome1,Outcome2] )).
%   Searching the text takes minutes, in one call of C.

test(uninterruptible_agent_is_ended,
     Outcome = raised(error(resource_error(seconds), _))) :-
    with_hosts([ c-[policy(guarded), cell(owner), quota([seconds(0.5)])] ],
               outcome([ (main :- text(1 000 000, "", Text),
                                  text(100 000, "b", Part),
                                  sub_string(Text, _, _, _, Part)),
                         (text(N, End, Text) :- length(Codes, N),
                                                maplist(=(0'a), Codes),
                                                string_codes(Text0, Codes),
                                                string_concat(Text0, End,
                                                              Text)) ],
                       Outcome)).
test(long_text_is_not_parsed_as_a_number, Lengths == [40 000,40 000]) :-
    length(Codes, 39 999),
    maplist(=(0'7), Codes),
    atom_codes(Atom, [0'a|Codes]),
    string_codes(String, [0'a|Codes]),
    cell(( create([ (main :- result([Atom,String])) ], A, [host(c)]),
           agent_result(A, Texts, 30) )),
    maplist(atom_length, Texts, Lengths).
test(many_agents_share_a_cell, Sum-Cells == 5050-1) :-
    cell(( numlist(1, 100, Ns),
           findall(A, ( member(N, Ns),
                        create([ n(N), (main :- n(N), sleep(0.05), result(N)) ],
                               A, [host(c)]) ), As),
           findall(R, ( member(A, As), agent_result(A, R, 60) ), Rs),
           sum_list(Rs, Sum),
           used_cells(Cells) )).

test(services_are_restricted_and_limited,
     Outcomes-Passed = [ done, done,
                          raised(error(resource_error(calls(twice/2)), _)),
                          raised(error(existence_error(procedure, _), _)) ]
                        -[calls(twice/2)]) :-
    Often = forall(between(1, 10, X), twice(X, _)),
    no_leaks(with_tmp_dir(bridge_called(
                                        [ (twice(2, Y), Y == 4),
                                          forall(between(1, 3, _), twice(2, 4)),
                                          Often, thrice(2, _) ],
                                        Ended, Passed))),
    findall(Outcome, member(_-Outcome, Ended), Outcomes).

test(supervisor_restarts_its_children, [Outcome,Last] == [done,disposed]) :-
    cell(( agent_create(agents(supervisor), S,
                        [ host(c),
                          facts([child(w, clauses([ (:- agent(w, [])),
                                                    (main :- receive(_), fail)
                                                  ]), [])]) ]),
           capturing(( result([ (main :- receive(_-ask(S1)), child(S1, A),
                                         send(A, go), another(S1, A)),
                                (another(S1, A) :- child(S1, B),
                                                   ( B \== A
                                                   -> send(S1, stop), result(B)
                                                   ;  sleep(0.02),
                                                      another(S1, A) )),
                                (child(S1, A) :-
                                     send(S1, children),
                                     receive(_-children(Pairs)),
                                     ( Pairs = [_-A] -> true
                                     ; sleep(0.02), child(S1, A) )) ], S, B),
                       agent_join(S, Outcome, 30),
                       agent_join(B, Last, 30) ), _) )).
test(gatekeeper_checks_each_predicate, Own == [clone/1,clone/2,deliver/1,
                                               dispose/0,move/1,move/2,
                                               receive/1,receive/2,
                                               undeliver/1]) :-
    findall(PI, ( vocabulary_word(_, PI), \+ cell_word(_, PI) ), PIs),
    sort(PIs, Own).

:- end_tests(cells).

result(Clauses, Ask, Result) :-
    create(Clauses, A, [host(c)]),
    agent_send(A, ask(Ask)),
    agent_result(A, Result, 120).

used_cells(Count) :-
    cells_list(Cells),
    findall(Key, ( member(cell(_, _, Key), Cells), Key \== spare ), Keys),
    length(Keys, Count).

%   Of a service with two predicates the place offers one, and an agent may
%   call it three times in a second.

%   Ended are the outcomes of Calls, Passed the quotas that were exceeded
%   according to the audit.

bridge_called(Calls, Ended, Passed, Dir) :-
    directory_file_path(Dir, place, File),
    directory_file_path(Dir, audit, Audit),
    write_file(File, ":- service(twice/2).~n", []),
    with_hosts([ c-[ policy(guarded), cell(host), consult(File), audit(Audit),
                     quota([calls(twice/2, 3)]) ] ],
               ( service_begin(bridge, c, [twice/2,thrice/2], test_cells, true),
                 findall(Call-Outcome, called(Calls, Call, Outcome), Ended) )),
    read_file_to_terms(Audit, Entries, []),
    findall(What, member(audit(_, c, _, _, over(_, What)), Entries), Passed).

called(Calls, Call, Outcome) :-
    member(Call, Calls),
    create([ (main :- Call) ], A, [host(c)]),
    capturing(agent_join(A, Outcome, 120), _).

:- public twice/2, thrice/2.

twice(X, Y) :- Y is 2*X.
thrice(X, Y) :- Y is 3*X.

served(Result, Dir) :-
    directory_file_path(Dir, place, File),
    write_file(File, ":- service(even/1).~neven(2).~neven(4).~nodd(1).~n", []),
    with_hosts([ c-[policy(guarded), cell(host), consult(File)] ],
               result([ (main :- findall(N, even(N), Ns), G = odd(_),
                                 ( catch(G, error(_, _), fail) -> R = yes
                                 ; R = no ),
                                 result(Ns-R)) ], Result)).

:- begin_tests(cell_processes).

test(hops_into_and_out_of_a_cell, Trip == [P,C,P,C]-[done,done]) :-
    no_leaks(with_peers(
        [p-[host([policy(guarded), cell(owner)])]],
        with_hosts([c], ( peer_host(p, P), address(c, C), trip(P, Trip) )))).
test(owners_do_not_share_a_cell, Keys == 2) :-
    no_leaks(with_peers(
        [p-[host([])]],
        with_hosts([c-[policy(guarded), cell(owner)]],
                   ( address(c, C),
                     sleeper(Sleeper),
                     peer_do(p, agent_create(clauses([(:- agent(s, [])),
                                                      (main :- move(C), sleep(60))]),
                                             _)),
                     create(Sleeper, _, [host(c)]),
                     wait_until(used_cells(2), 30),
                     used_cells(Keys) )))).
test(halting_process_leaves_no_files, Files == []) :-
    with_tmp_dir(left_in(Files)).
test(cells_end_with_their_process, Dead == true) :-
    no_leaks(with_peers(
        [p-[host([policy(guarded), cell(owner)])]],
        ( peer_do(p, typhon_cells:cells_list(Cells)),
          Cells = [cell(_, Pid, _)|_],
          peer_crash(p),
          ( wait_until(is_dead(Pid), 20) -> Dead = true ; Dead = false ) ))).
test(killed_cell_ends_only_its_running_agents,
     Lost-Result = lost(cell(killed(9)))-awake) :-
    cell(( create([(main :- receive(_-go), result(awake))], Rests, [host(c)]),
           wait_state(Rests, waiting),
           create([(main :- repeat, fail)], Runs, [host(c)]),
           wait_state(Runs, running),
           wait_until(used_cells(1), 30),
           cells_list(Cells),
           once(( member(cell(_, Pid, Key), Cells), Key \== spare )),
           capturing(( process_kill(Pid, kill), agent_join(Runs, Lost, 30) ),
                     Messages),
           assertion(memberchk(warning-typhon(cell_ended(_, c, _, lost(_))),
                               Messages)),
           agent_send(Rests, go),
           agent_result(Rests, Result, 30) )).
test(interrupted_turn_is_repeated_once_with_a_journal,
     [ condition(missing([journal], [])),
       forall(member(Before-Kills-Expected,
                     [ true-1-(done-1), true-2-(lost-0),
                       (mark, repeat, sense(h))-1-(lost-0) ])),
       Result == Expected ]) :-
    no_leaks(with_tmp_dir(killed(Before, Kills, Result))).
test(more_owners_than_cells, Count == 1) :-
    with_settings([typhon_cells:cells=1],
        no_leaks(with_peers(
            [p-[host([])]],
            with_hosts([c-[policy(guarded), cell(owner)]],
                ( address(c, C),
                  numlist(1, 5, Ns),
                  findall(A, ( member(_, Ns), one_of_each(C, A) ), Pairs),
                  forall(( member(As, Pairs), member(A, As) ),
                         ( agent_join(A, O, 60), assertion(O == done) )),
                  used_cells(Count) ))))).
test(process_ends_after_the_start_of_a_cell_is_complete, Marks == [done]) :-
    with_tmp_dir(ends_amid_a_start(Marks)).
test(slow_start_of_a_cell_does_not_disable_cells,
     error(timeout_error(start_cell, _))) :-
    with_settings([typhon_cells:start=0.5],
                  with_tmp_dir(started_by_slow_bubblewrap)).
test(agents_keep_the_policy_of_their_admission, Formals-Cells == [no,yes]-1) :-
    cell(( tries(Clauses),
           create(Clauses, Old, [host(c)]),
           host_change(c, policy(trusted)),
           create(Clauses, New, [host(c)]),
           findall(F, ( member(A, [Old,New]), agent_send(A, go),
                        agent_result(A, F, 30) ), Formals),
           used_cells(Cells) )).
test(changing_to_guarded_enables_cells, Cells-Result == 1-no) :-
    with_hosts([c], ( host_change(c, policy(guarded)),
                      tries(Clauses),
                      create(Clauses, A, [host(c)]),
                      agent_send(A, go),
                      agent_result(A, Result, 120),
                      used_cells(Cells) )).
test(guarded_policy_gives_each_owner_a_cell, Cells == 1) :-
    with_hosts([c-[policy(guarded)]], ( outcome([main], done),
                                        used_cells(Cells) )).
:- end_tests(cell_processes).

%   ends_amid_a_start(-Marks, +Dir): a process halts while a bubblewrap has
%   written `begun` and not `done` yet. Marks are the files after that.

ends_amid_a_start(Marks, Dir) :-
    absolute_file_name(path(bwrap), Bwrap, [access(execute)]),
    directory_file_path(Dir, bwrap, File),
    format(string(Script),
           "cd ~w; touch begun; sleep 1; mv begun done; exec ~w \"$@\"",
           [Dir, Bwrap]),
    shell_script(File, Script),
    chmod(Dir, +rwx),                 % a process of root gives cells other users
    getenv('PATH', Path),
    format(atom(Goal),
           'use_module(library(typhon)),\c
            host_start(c, [policy(guarded), cell(owner)]),\c
            setenv(\'PATH\', \'~w:~w\'),\c
            agent_create(clauses([(:- agent(a, [])), (main :- true)]), _,\c
                         [host(c)]),\c
            repeat, exists_file(\'~w/begun\'), !', [Dir, Path, Dir]),
    run_swipl(['-g', Goal, '-t', halt], [], exit(0), _, _),
    findall(Mark, ( member(Mark, [begun,done]),
                    directory_file_path(Dir, Mark, MarkFile),
                    exists_file(MarkFile) ), Marks).

started_by_slow_bubblewrap(Dir) :-
    directory_file_path(Dir, bwrap, File),
    shell_script(File, "exec sleep 100"),
    getenv('PATH', Path),
    atomic_list_concat([Dir,Path], :, Slow),
    setup_call_cleanup(
        setenv('PATH', Slow),
        host_start(c, [policy(guarded)]),
        setenv('PATH', Path)).

%   left_in(-Files, +Dir): the files in Dir, the directory for temporary files
%   of a process that halts while a host has cells.

left_in(Files, Dir) :-
    format(atom(Goal),
           'set_prolog_flag(tmp_dir,~q),use_module(library(typhon)),\c
            host_start(a,[policy(guarded),cell(owner)])', [Dir]),
    run_swipl(['-g', Goal, '-t', halt], [], exit(0), _, _),
    directory_files(Dir, All),
    subtract(All, ['.', '..'], Files).

%   killed(+Before, +Kills, -Result, +Dir): the cell of an agent is killed
%   Kills times while the agent runs. Result is its outcome, and the number of
%   facts that it has left.

killed(Before, Kills, How-Count, Dir) :-
    atomic_list_concat([Dir, /, p], J),
    atomic_list_concat([Dir, /, mark], Mark),
    atomic_list_concat([Dir, /, place], Place),
    write_file(Place, ":- service(mark/0).~n\c
                       mark :- open(~q, write, Out), close(Out).~n", [Mark]),
    Works = clauses([ (:- agent(works, [])),
                      (main :- Before, leave(f), work, result(done)),
                      (work :- between(1, 5 000 000, X), X >= 5 000 000, !) ]),
    with_peers(
        [p-[host([ policy(guarded), cell(owner), quota([seconds(60)]),
                   journal(J), consult(Place) ])]],
        ( peer_host(p, P),
          peer_do(p, agent_create(Works, A)),
          (   Before == true
          ->  true
          ;   wait_until(exists_file(Mark), 30)
          ),
          kills(Kills, none),
          peer_do(p, agent_join(A, Outcome, 60)),
          functor(Outcome, How, _),
          findall(f, remote(P, sense(f)), Fs) )),
    length(Fs, Count).

kills(0, _) :-
    !.
kills(Kills, Last) :-
    wait_until(( peer_do(p, typhon_cells:cells_list(Cells)),
                 member(cell(Cell, Pid, Key), Cells),
                 Cell \== Last, Key \== spare ), 30),
    process_kill(Pid, kill),
    Kills1 is Kills-1,
    kills(Kills1, Cell).

%   cell_session_nice(-Nice): the process below bwrap is in a session of its own.

cell_session_nice(Nice) :-
    busy_cell(Child),
    format(atom(Group), '/proc/~d/autogroup', [Child]),
    read_file_to_string(Group, Line, []),
    split_string(Line, " ", " \n", [_,_,Nice]).

cell_nice(Nice) :-
    busy_cell(Child),
    process_nice(Child, Nice).

busy_cell(Child) :-
    cells_list(Cells),
    once(( member(cell(_, Pid, Key), Cells), Key \== spare )),
    format(atom(Children), '/proc/~w/task/~w/children', [Pid, Pid]),
    read_file_to_string(Children, Text, []),
    split_string(Text, " ", " ", [First|_]),
    number_string(Child, First).

%   The result is `yes` if the agent can do what the rules refuse.

tries([ plan(nb_setval(test_cells, 1)),
        (main :- receive(_-go), plan(G),
                 ( catch(G, error(_, _), fail) -> result(yes) ; result(no) ))
      ]).

trip(P, Trip-[Outcome1,Outcome2]) :-
    Clauses = [ (:- dynamic(seen/1)),
                (main :- receive(_-go(P, C)), visit(P), visit(C), visit(P),
                         visit(C), findall(H, seen(H), Hs), result(Hs)),
                (visit(H) :- move(H), here(There), assertz(seen(There))) ],
    create(Clauses, A, [host(c)]),
    address(c, C),
    agent_send(A, go(P, C)),
    agent_result(A, Trip, 60),
    agent_join(A, Outcome1, 5),
    agent_create(clauses([(:- agent(y, [])), (main :- sleep(0), result(1))]), B,
                 [host(P)]),
    agent_result(B, 1, 30),
    agent_join(B, Outcome2, 5).

sleeper([(main :- sleep(60))]).

one_of_each(C, [A,B]) :-
    create([(main :- sleep(0.01))], A, [host(c)]),
    peer_do(p, agent_create(clauses([(:- agent(s, [])),
                                     (main :- move(C), sleep(0.01))]), B)).
