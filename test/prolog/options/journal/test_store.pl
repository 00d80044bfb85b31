:- use_module('../../../lib/common').
:- use_module('../../../lib/failing_disk').
:- use_module('../../../lib/stores').
:- use_module('../../../lib/texts', [message_text/2]).
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_codes/3]).
:- use_module(library(typhon/kernel/base/durable)).
:- use_module(library(typhon/kernel/base/on_demand), [on_demand_load/2]).

:- needs([journal]).

:- on_demand_load(host_option, journal).

:- begin_tests(store).

test(store_keeps_what_is_committed, [forall(stored(What)), nondet]) :-
    with_tmp_dir(store_keeps(What)).

%   The longest keys, and characters of several bytes.

test(all_kinds_of_keys_are_distinct) :-
    with_tmp_dir(keys).

keys(Dir) :-
    findall(Key, ( member(Length, [1, 499, 500]),
                   member(Code, [0'x, 0'', 0x4e00, 0x1f600]),
                   length(Codes, Length),
                   maplist(=(Code), Codes),
                   atom_codes(Key, Codes),
                   durable_key(Key, 0) ), Keys),
    assertion(length(Keys, 12)),
    findall(a-Key-0-Key, member(Key, Keys), Specs),
    with_store(Dir, commit(Specs)),
    with_store(Dir, items(a, Items)),
    forall(member(Key, Keys), memberchk(Key-0-Key, Items)),
    assertion(length(Items, 12)).

test(invalid_keys,
     [ forall(no_key(Key, N)), fail ]) :-
    durable_key(Key, N).

no_key(Key, N) :-
    member(Key-N, [ _-0, f(x)-0, "text"-0, key-_, key-1.5,
                    key-9223372036854775808, key-(-9223372036854775809),
                    'a\000\b'-0 ]).
no_key(Key, 0) :-
    format(atom(Key), '~`xt~501|', []).
no_key(Half, 0) :-
    catch(atom_codes(Half, [0xdc00]), error(_, _), fail).   % fails in 10.1

test(keys_of_64_bits, forall(member(N, [ -9223372036854775808,
                                         9223372036854775807 ]))) :-
    durable_key(key, N).

test(other_process_is_locked_out,
     [error(permission_error(open, journal, _))]) :-
    with_tmp_dir(Dir,
        ( while_open_elsewhere(Dir, _, with_store(Dir, true)) )).

%   1 survives the end of the process, 2 a power failure as well.

test(commits_are_synced_on_demand,
     [ forall(member(Sync-Expected, [normal-1, full-2])),
       true(Synchronous == Expected) ]) :-
    with_tmp_dir(Dir,
        ( with_store(Dir, Sync,
                     ( odbc:odbc_current_connection(Connection, _),
                       odbc:odbc_query(Connection, 'pragma synchronous',
                                       row(Synchronous), [types([integer])]) )) )).

test(foreign_file_is_not_touched,
     [error(journal_damaged(_, _))]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'journal.db', File),
          setup_call_cleanup(open(File, write, Out),
                             forall(between(1, 5000, I), writeln(Out, I)),
                             close(Out)),
          unchanged(File, with_store(Dir, true)) )).

:- meta_predicate unchanged(+, 0).

unchanged(File, Goal) :-
    read_file_to_codes(File, Before, [type(binary)]),
    catch(Goal, error(Formal, Context), true),
    read_file_to_codes(File, After, [type(binary)]),
    Before == After,
    throw(error(Formal, Context)).

%   A page in the middle of the file is overwritten.

test(damaged_page_is_detected_when_the_journal_is_opened,
     [error(journal_damaged(_, _))]) :-
    with_tmp_dir(damaged_page).

damaged_page(Dir) :-
    findall(a-k-N-Text,
            ( between(1, 400, N), format(string(Text), "~`xt~1000|", []) ),
            Specs),
    with_store(Dir, commit(Specs)),
    directory_file_path(Dir, 'journal.db', File),
    size_file(File, Size),
    setup_call_cleanup(
        open(File, update, Out, [type(binary)]),
        ( Middle is (Size//8192)*4096,
          seek(Out, Middle, bof, _),
          forall(between(1, 4096, I), ( Byte is I mod 251, put_byte(Out, Byte) )) ),
        close(Out)),
    with_store(Dir, true).

test(damaged_term_is_detected,
     [error(journal_damaged(_, a-k))]) :-
    with_tmp_dir(Dir,
        ( with_store(Dir, commit([a-k-0-hello(world), b-k-0-hello(wordl)])),
          sql(Dir, 'update item set value=(select value from item \c
                    where kind=\'b\') where kind=\'a\''),
          with_store(Dir, items(a, _)) )).

test(journal_of_another_version_is_refused,
     [error(journal_version(_, 99))]) :-
    with_tmp_dir(Dir,
        ( with_store(Dir, commit([a-k-0-hello])),
          sql(Dir, 'update about set version=99'),
          with_store(Dir, true) )).

sql(Dir, Sql) :-
    directory_file_path(Dir, 'journal.db', File),
    process_create(path(sqlite3), [File, Sql], [process(Pid)]),
    process_wait(Pid, exit(0)).

test(full_disk_is_reported_and_loses_nothing) :-
    with_tmp_dir(full).

full(Dir) :-
    numlist(1, 20000, List),
    with_store(Dir,
               ( commit([a-k-0-first]),
                 odbc:odbc_current_connection(Connection, _),
                 odbc:odbc_query(Connection, 'pragma max_page_count=1', _, []),
                 catch(commit([a-k-0-second, a-l-0-List]), error(Full, _), true),
                 odbc:odbc_query(Connection, 'pragma max_page_count=100000',
                                 _, []),
                 items(a, Items),
                 commit([a-l-0-List]),
                 items(a, [k-0-first, l-0-List]) )),
    Full == resource_error(journal_space),
    message_text(error(Full, _), "There is no space left for the journal\n"),
    Items == [k-0-first].

%   Each commit is that of an item; a process reports its results as text.

test(errors_of_the_disk_have_their_names,
     [ condition(disk_can_fail),
       forall(member(Call-Errors, [ 'write-28'-[space,none,none,[1,2,3]],
                                    'write-122'-[space,none,none,[1,2,3]],
                                    'write-27'-[space,none,none,[1,2,3]],
                                    'fsync-5'-[unwritten,unwritten,none,_],
                                    'write-5'-[unwritten,unwritten,none,_] ])),
       true(Found = Errors) ]) :-
    with_failing_disk(Environment, with_tmp_dir(disk(Call, Environment, Found))).

disk(Call, Environment, Found, Dir) :-
    project_file('test/lib/disk_main.pl', Main),
    run_swipl(['-g', main, '-t', halt, Main, '--', Call, Dir],
              [environment(Environment)], exit(0), Out, _),
    term_string(Found, Out).

:- end_tests(store).
