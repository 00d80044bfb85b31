:- use_module('../../../lib/common').
:- use_module('../../../lib/failing_disk').
:- use_module('../../../lib/journaled').
:- use_module('../../../lib/redis').
:- use_module('../../../lib/stores').
:- use_module('../../../lib/texts', [message_text/2]).
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [last/2, member/2, numlist/3]).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/journal),
              [ journal_part/3, journal_place/2, journal_record/2,
                journal_record_drop/1, journal_record_put/2 ]).

:- needs([fleet]).

/** <module> Tests of journals in the engine of a fleet

The operations of the store, also while the engine is killed, stopped, emptied
or set back, and another process takes the journal over.
*/

:- begin_tests(fleet_journal).

:- meta_predicate
    in_lab(-, 0),
    in_lab(+, -, 0),
    with_journal(0),
    error_of(0, -).

in_lab(Redis, Goal) :-
    in_lab([], Redis, Goal).

%   The thread that reads the setting ends before this does.

in_lab(Options, Redis, Goal) :-
    with_settings([typhon_fleet:fenced_exit=false],
                  no_leaks(with_redis(Options, Redis, joined(Redis, Goal)))).

:- meta_predicate joined(+, 0).

joined(Redis, Goal) :-
    redis_address(Redis, Address),
    setup_call_cleanup(fleet_join(lab, [redis(Address), lease(0.5)]),
                       once(Goal),
                       fleet_leave(lab)).

with_journal(Goal) :-
    with_store(redis('lab/a'), Goal).

error_of(Goal, Formal) :-
    catch(( Goal, Formal0 = none ), error(Formal0, _), true),
    Formal = Formal0.

%   While the engine is away, for half a second no call reaches it.

eventually(Goal) :-
    wait_until(( error_of(Goal, Formal),
                 ( Formal = journal_unreachable(_, _) -> fail ; true ) ), 10),
    assertion(Formal == none).

:- meta_predicate eventually(0).

                /*******************************
                *           THE STORE          *
                *******************************/

test(store_keeps_what_is_committed, [forall(stored(What)), nondet]) :-
    atom_concat('lab/', What, Path),
    in_lab(_, store_keeps(What, redis(Path))).
test(names_of_journals,
     [ forall(member(Path-Expected,
                     [ 'lab/a'-'redis:lab/a', 'lab/a/b'-'redis:lab/a/b',
                       lab-error, '/a'-error, 'lab/'-error ])),
       true(Found == Expected) ]) :-
    catch(journal_place(redis(Path), Found),
          error(domain_error(fleet_journal, Path), _), Found = error).
test(journals_of_a_network_have_names, Part == redis('lab/net.process3')) :-
    journal_part(redis('lab/net'), 3, Part).
test(fleet_must_be_joined, Text == true) :-
    catch(host_start(alpha, [journal(redis('lob/a'))]),
          error(existence_error(fleet, lob), Context), true),
    in_lab(_, ( message_text(error(existence_error(fleet, lob), Context), Said),
                ( sub_string(Said, _, _, _, "lab") -> Text = true
                ; Text = Said ) )).
test(record_of_a_network_is_kept) :-
    in_lab(_, ( Where = redis('lab/net'),
                \+ journal_record(Where, _),
                journal_record_put(Where, "a 'text'"),
                journal_record(Where, "a 'text'"),
                journal_record_drop(Where),
                \+ journal_record(Where, _) )).
test(damaged_term_is_detected, Formal = journal_damaged(_, a-k)) :-
    in_lab(Redis,
           ( with_journal(commit([a-k-0-hello(world)])),
             redis_line(Redis, [hset, 'f:{lab}:i:a', 'a 0 k', '0000abc'], _),
             error_of(with_journal(items(a, _)), Formal) )).
test(journal_of_another_version_is_refused, Formal = journal_version(_, 99)) :-
    in_lab(Redis,
           ( with_journal(commit([a-k-0-hello(world)])),
             redis_line(Redis, [hset, 'f:{lab}:i:a', about, '99 x'], _),
             error_of(with_journal(true), Formal) )).
test(commit_without_space_is_repeated) :-
    in_lab(Redis,
           with_journal(
               ( redis_line(Redis, [config, set, maxmemory, 1], _),
                 error_of(commit([a-k-0-x]), resource_error(journal_space)),
                 redis_line(Redis, [config, set, maxmemory, 0], _),
                 commit([a-l-0-y]),
                 items(a, Items) ))),
    msort(Items, [k-0-x, l-0-y]).

%   Redis takes no commands that write while it cannot write its file.

test(engine_with_a_full_disk_takes_commits_when_there_is_space,
     [condition(disk_can_fail), true(Items == [k-0-x, l-0-y])]) :-
    with_failing_disk(Environment,
        ( forall(member(Name=Value, Environment), setenv(Name, Value)),
          in_lab(['--appendfsync', everysec], _, full_disk(Items)) )).

full_disk(Items) :-
    unsetenv('LD_PRELOAD'),
    with_journal(( commit([a-k-0-w]),
                   disk_fails(write-28),
                   wait_until(error_of(commit([a-k-0-x]),
                                       resource_error(journal_space)), 10),
                   disk_heals,
                   wait_until(error_of(commit([a-l-0-y]), none), 10) )),
    with_journal(items(a, Items0)),
    msort(Items0, Items).

%   An item of four calls, and many items.

test(long_commits_go_in_parts) :-
    numlist(1, 300000, Long),
    findall(a-K-N-f(N, "some text"),
            ( between(1, 20, K0), atom_number(K, K0), between(1, 1000, N) ),
            Many),
    in_lab(_, ( with_journal(commit([b-k-0-Long, b-l-0-Long|Many])),
                with_journal(( items(b, [_-0-Long, _-0-Long]),
                               items(a, Items),
                               commit([drop(b, k, 0)]),
                               items(b, [l-0-_]) )) )),
    length(Items, 20000).

                /*******************************
                *       OTHER PROCESSES        *
                *******************************/

before(Redis, Before) :-
    before(Redis, 0.5, Before).

before(Redis, Lease, fleet_join(lab, [redis(Address), lease(Lease)])) :-
    redis_address(Redis, Address).

test(other_process_is_locked_out_until_its_lease_lapses) :-
    in_lab(Redis, locked_out(Redis)).

locked_out(Redis) :-
    before(Redis, 60, Before),
    while_open_elsewhere(Before, redis('lab/a'), Pid,
               ( error_of(with_journal(true),
                          permission_error(open, journal, 'redis:lab/a')),
                 with_store(redis('lab/b'), true),
                 process_kill(Pid, kill),
                 process_wait(Pid, _),
                 redis_line(Redis, [pexpire, 'f:{lab}:j:a:lease', 100], _),
                 wait_until(error_of(with_journal(true), none), 20) )).

%   The engine is not asked again, and the hook is called once.

test(process_whose_journal_was_taken_over_commits_nothing_more,
     [ forall(member(Ends, [true, gives_back])), true(Told == ['redis:lab/a']) ]) :-
    in_lab(Redis, taken_over(Redis, Ends, Told)).

:- dynamic told/1.
:- multifile typhon_store:fenced/1.

typhon_store:fenced(Place) :-
    assertz(plunit_fleet_journal:told(Place)).

taken_over(Redis, Ends, Told) :-
    retractall(told(_)),
    Formal = permission_error(open, journal, 'redis:lab/a'),
    with_journal(
        ( commit([a-k-0-first]),
          usurped(Redis),
          call(Ends),
          forall(between(1, 2, _),
                 error_of(commit([a-k-0-second]), Formal)) )),
    findall(Place, retract(told(Place)), Told),
    gives_back,
    with_journal(items(a, [k-0-first])).

%   The other process closes it.

gives_back :-
    nb_getval(usurper, Owner),
    typhon_engine:engine_script(lab, journal_renew, [a, Owner, 0], _).

%   Another process opens the journal, as if the lease had lapsed.

usurped(Redis) :-
    redis_line(Redis, [hget, 'f:{lab}:i:a', about], [About]),
    wait_until(( redis_line(Redis, [del, 'f:{lab}:j:a:lease'], _),
                 typhon_engine:engine_script(lab, journal_open,
                                             [a, other, 500, About], Answer),
                 Answer = ["ok", Owner|_] ), 5),
    nb_setval(usurper, Owner).

%   A process is suspended, and its journal opened here; when it goes on it
%   commits nothing, and ends.

test(suspended_process_is_fenced, Items == [k-0-here]) :-
    in_lab(Redis, suspended(Redis, Items)).

suspended(Redis, Items) :-
    before(Redis, Before),
    committing(Before, Pid, In, Out,
               ( commits(In, Out, "done"),
                 stop_process(Pid),
                 with_journal(( commit([a-k-0-here]),
                                process_kill(Pid, cont),
                                format(In, '0.~n', []),
                                flush_output(In),
                                wait_for_end(Pid, 60, Status),
                                items(a, Items) )),
                 assertion(Status == exit(75)) )).

:- meta_predicate committing(+, -, -, -, 0).

committing(Before, Pid, In, Out, Goal) :-
    project_file('test/lib/stores.pl', Stores),
    project_file('prolog/typhon.pl', Library),
    format(atom(Opens), '~q, ~q, ~q', [use_module(Library), Before,
                        with_store(redis('lab/a'), user:loop)]),
    Loop = ( loop :- read(N),
                     catch(( commit([a-k-0-N]), Done = done ), error(E, _),
                           functor(E, Done, _)),
                     writeln(Done), flush_output, loop ),
    format(atom(Asserts), '~q', [assertz(Loop)]),
    with_swipl(['-g', Asserts, '-g', Opens, '-t', halt, Stores], Pid, In, Out,
               Goal).

commits(In, Out, Answer) :-
    random_between(1, 1000, N),
    format(In, '~d.~n', [N]),
    flush_output(In),
    read_line_to_string(Out, Answer).

test(delayed_commit_is_dropped) :-
    in_lab(Redis,
           ( with_journal(( commit([a-k-0-first]),
                            commit([a-k-0-second]),
                            delayed(Redis),
                            items(a, [k-0-second]) )),
             with_journal(items(a, [k-0-second])) )).

delayed(Redis) :-
    redis_line(Redis, [get, 'f:{lab}:j:a:owner'], [Owner]),
    typhon_engine:engine_script(lab, journal_commit,
                                [a, Owner, 0, 1, 1000, none, 0, 'a 0 k'], _).

                /*******************************
                *          THE ENGINE          *
                *******************************/

test(process_continues_after_the_engine_was_away,
     [ forall(member(Goes-Returns,
                     [ redis_signal(kill)-redis_restart,
                       redis_signal(stop)-redis_signal(cont) ])) ]) :-
    in_lab(Redis, engine_away(Redis, Goes, Returns)).

redis_signal(Signal, Redis) :-
    test_redis:redis_signal(Redis, Signal).

engine_away(Redis, Goes, Returns) :-
    with_journal(( commit([a-k-0-first]),
                   call(Goes, Redis),
                   forall(between(1, 2, _),
                          error_of(commit([a-k-0-second]),
                                   journal_unreachable('redis:lab/a', _))),
                   call(Returns, Redis),
                   eventually(commit([a-l-0-third])) )),
    with_journal(items(a, Items)),
    msort(Items, [k-0-second, l-0-third]).

%   Of many random commits, some of which the engine forgets, it has all in the
%   end: all is as without the engine.

test(forgotten_commits_are_written_again,
     [ forall(member(Forgets, [redis_empty, set_back, torn])) ]) :-
    in_lab(Redis, forgotten(Redis, Forgets)).

forgotten(Redis, Forgets) :-
    with_journal(
        ( commit([a-m-0-here]),
          random_commits(20),
          kept(Redis),
          random_commits(20),
          call(Forgets, Redis),
          eventually(commit([a-z-0-last])),
          items(a, Items) )),
    with_journal(items(a, Found)),
    assertion(memberchk(z-0-last, Items)),
    assertion(memberchk(m-0-here, Items)),
    msort(Items, Sorted),
    assertion(msort(Found, Sorted)).

random_commits(Count) :-
    forall(between(1, Count, _),
           ( findall(Spec, ( between(1, 3, _), random_spec(Spec) ), Specs),
             commit(Specs) )).

random_spec(Spec) :-
    random_member(Key, [k, l]),
    random_between(1, 9, N),
    random_between(1, 1000000, Term),
    random_member(Spec, [ a-Key-N-Term, a-Key-N-Term, a-Key-N-Term,
                          drop(a, Key, N), drop_below(a, Key, N),
                          drop_all(a, Key) ]).

kept(redis(_, Dir, _)) :-
    log_file(Dir, File),
    size_file(File, Size),
    nb_setval(kept, Size).

%   The engine loses all after a moment, or its file is cut in the middle of a
%   commit.

set_back(Redis) :-
    nb_getval(kept, Size),
    cut_to(Size, Redis).

torn(Redis) :-
    nb_getval(kept, Size0),
    Size is Size0+77,
    cut_to(Size, Redis).

cut_to(Size, Redis) :-
    redis_signal(kill, Redis),
    Redis = redis(_, Dir, _),
    log_file(Dir, File),
    setup_call_cleanup(open(File, update, Out, [type(binary)]),
                       ( seek(Out, Size, bof, _), set_end_of_stream(Out) ),
                       close(Out)),
    size_file(File, Size),
    redis_restart(Redis).

log_file(Dir, File) :-
    findall(F, directory_member(Dir, F, [recursive(true), extensions([aof])]),
            Files),
    member(File, Files),
    sub_atom(File, _, _, _, '.incr.'),
    !.

%   It has opened the journal later, and commits first: the other has to wait.

test(empty_engine_belongs_to_the_process_that_opened_the_journal_last) :-
    in_lab(Redis, emptied(Redis)).

emptied(Redis) :-
    with_journal(
        ( commit([a-k-0-first]),
          usurped(Redis),
          nb_getval(usurper, Later),
          redis_empty(Redis),
          error_of(commit([a-k-0-second]), journal_unreachable(_, _)),
          typhon_engine:engine_script(lab, journal_claim, [a, Later, 500],
                                      Answer),
          assertion(memberchk(Answer, ["wait", "ok"])),
          error_of(commit([a-k-0-second]),
                   permission_error(open, journal, _)) )).

test(journal_that_was_not_filled_to_the_end_is_damaged,
     Formal = journal_damaged(_, _)) :-
    in_lab(Redis,
           ( with_journal(( commit([a-k-0-first]),
                            redis_empty(Redis),
                            error_of(commit([]), journal_unreachable(_, _)) )),
             error_of(with_journal(true), Formal) )).

                /*******************************
                *            AGENTS            *
                *******************************/

test(agent_survives_a_killed_process) :-
    with_redis(Redis, ( backend(Redis, Backend), agent_survives(Backend) )).
test(agent_goes_on_when_the_engine_returns,
     [ forall(member(Goes-Returns,
                     [ redis_signal(kill)-redis_restart,
                       redis_signal(stop)-redis_signal(cont),
                       emptied_and_killed-redis_restart ])) ]) :-
    with_redis(Redis, ( backend(Redis, Backend),
                        agent_goes_on(Backend, call(Goes, Redis),
                                      call(Returns, Redis)) )).

backend(Redis, backend(Before, redis('lab/a'))) :-
    before(Redis, Before).

emptied_and_killed(Redis) :-
    redis_empty(Redis),
    redis_signal(kill, Redis).

:- end_tests(fleet_journal).
