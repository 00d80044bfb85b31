:- module(test_log, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures', [capturing/2, was_printed/2]).
:- use_module('../../lib/texts', [write_file/2]).
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(thread), [concurrent_forall/3]).
:- use_module(library(filesex),
              [chmod/2, directory_file_path/3, link_file/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(uid), [geteuid/1]).
:- use_module(library(typhon/kernel/wire),
              [endpoint_address/1, endpoint_post/3, endpoint_stop/0]).
:- use_module(library(typhon)).

%   with_log(+Options, -Address, -File, :Goal, -Events): with a server running.

:- meta_predicate with_log(+, -, -, 0, -).

with_log(Options, Address, File, Goal, Events) :-
    with_tmp_dir(Dir,
                 ( directory_file_path(Dir, 'events.pl', File),
                   log_server_start([file(File)|Options], Address),
                   call_cleanup(once(Goal), log_server_stop(Address)),
                   log_events(File, Events) )).

arrives(Address, Host, Agent, What) :-
    typhon_endpoint:received(log, event(Address, Host, Agent, What), tester).

%   quietly(:Goal, -Messages): the messages typhon(_) that Goal printed.

:- meta_predicate quietly(0, -).

quietly(Goal, Messages) :-
    capturing(Goal, All),
    findall(M, member(_-typhon(M), All), Messages).

printed(Message) :-
    was_printed(_, typhon(Message)).

odd_term(Term) :-
    member(Term,
           [ 'it''s a "quoted" \\ atom', "a string\nof two lines\t",
             '\x1\\x7f\é日本😀', (a :- b),
             [:-, (','), '|', {}, [], '[]', '{}', -, (dynamic)],
             - 1 - -1 - (-(1)) - -(-(a)), (p :- a, b ; c -> d), {x,y},
             f(1.0e10, 0.1, -0.0, 5.0e-324), 123456789012345678901234567890,
             '$VAR'(1), '$VAR'('X'), ['.', 'a.b', '. ', '%', '/*'],
             f(X, _, X) ]).
odd_term(X) :-
    X is inf.
odd_term(X) :-
    compound_name_arguments(X, foo, []).

:- begin_tests(log_server, [cleanup(stop_endpoint)]).

stop_endpoint :-
    (   endpoint_address(_)
    ->  endpoint_stop
    ;   true
    ).

test(address) :-
    with_log([], Address, _,
             ( endpoint_address(Endpoint),
               atom_concat('log@', Endpoint, Address) ), _).

test(events_are_stamped_in_order_of_arrival, Times == Sorted) :-
    get_time(T0),
    with_log([], Address, _, hundred(Address), Events),
    get_time(T1),
    findall(N, member(event(_, h, a, step(N)), Events), Ns),
    numlist(1, 100, Ns),
    findall(T, member(event(T, _, _, _), Events), Times),
    msort(Times, Sorted),
    forall(member(T, Times), ( T > T0 - 0.001, T < T1 + 0.001 )).

hundred(Address) :-
    forall(between(1, 100, N), arrives(Address, h, a, step(N))).

test(received_events_are_read_at_once) :-
    with_log([], Address, File,
        ( forall(between(1, 100, N),
                 ( arrives(Address, h, a, step(N)),
                   log_events(File, Events),
                   assertion(length(Events, N)) )) ), _).
test(clock) :-
    get_time(Now),
    Epoch is Now - 10,
    with_log([clock(Epoch, 50)], Address, _,
        arrives(Address, h, a, x), [event(Time, h, a, x)]),
    get_time(After),
    Time >= 500,
    Time < (After-Epoch)*50.
test(every_term_reads_back) :-
    findall(X, odd_term(X), Odd),
    with_log([], Address, _, odd(Address), Events),
    findall(X, member(event(_, h, a, X), Events), Read),
    Read =@= Odd.
test(one_fact_per_line) :-
    with_log([], Address, File,
        ( odd(Address),
          aggregate_all(count, odd_term(_), Count),
          wait_until(( read_file_to_string(File, Text, [encoding(octet)]),
                       split_string(Text, "\n", "", Lines),
                       length(Lines, Length),
                       Length =:= Count + 1 ), 5),
          string_codes(Text, Codes),
          forall(member(Code, Codes), Code < 128) ), _).

odd(Address) :-
    forall(odd_term(X), arrives(Address, h, a, X)).

test(readable_under_any_operator_table) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'events.pl', File),
          log_server_start([file(File)], Address),
          odd(Address),
          log_server_stop(Address),
          Ops = [op(200, xfy, event), op(700, fx, h), op(0, xfx, :-),
                 op(0, yfx, -), op(0, fy, -), op(900, yf, a)],
          forall(member(op(P, T, N), Ops), op(P, T, test_log_reader:N)),
          load_files(test_log_reader:File, [silent(true)]),
          findall(X, test_log_reader:event(_, h, a, X), Read),
          findall(X, odd_term(X), Odd),
          Read =@= Odd )).
test(buffer_is_written_when_idle) :-
    with_log([], Address, File,
        ( arrives(Address, h, a, x),
          wait_until(log_events(File, [_]), 5) ), _).
test(stop_writes_buffered_events, Count == 20000) :-
    with_log([], Address, _,
        forall(between(1, 20000, N), arrives(Address, h, a, N)), Events),
    length(Events, Count).
test(posts_of_this_process_arrive_before_the_stop, Numbers == Expected) :-
    numlist(1, 5000, Expected),
    with_log([], Address, _,
             ( endpoint_address(Endpoint),
               forall(member(N, Expected),
                      endpoint_post(Endpoint, log, event(Address, h, a, N))) ),
             Events),
    findall(N, member(event(_, h, a, N), Events), Numbers).
test(many_senders_at_once) :-
    numlist(1, 8, Threads),
    with_log([], Address, _,
        concurrent_forall(member(T, Threads),
                          forall(between(1, 500, N),
                                 arrives(Address, T, a, N)),
                          [threads(8)]), Events),
    numlist(1, 500, Steps),
    forall(member(T, Threads),
           ( findall(N, member(event(_, T, a, N), Events), Ns),
             Ns == Steps )).

test(two_servers_in_one_process, A-B == [to(a)]-[to(b)]) :-
    with_log([name(a)], AddressA, _,
        with_log([name(b)], AddressB, _,
            ( arrives(AddressA, h, x, to(a)),
              arrives(AddressB, h, x, to(b)) ), EventsB), EventsA),
    findall(W, member(event(_, _, _, W), EventsA), A),
    findall(W, member(event(_, _, _, W), EventsB), B).
test(started_twice, error(permission_error(start, log_server, log))) :-
    with_log([], _, _, with_log([], _, _, true, _), _).
test(started_again_after_an_error, Events == []) :-
    with_log([], _, _, true, Events).
test(stopped_twice, error(existence_error(log_server, _))) :-
    with_log([], Address, _, true, _),
    log_server_stop(Address).

test(bad_options,
     [ forall(member(Options-Formal,
                     [ [file('/tmp/x'), colour(red)]-
                       domain_error(log_server_option, colour(red)),
                       []-existence_error(option, file),
                       [file('/no/such/directory/events')]-
                       existence_error(directory, '/no/such/directory'),
                       [file('/proc/typhon_log')]-
                       permission_error(open, source_sink,
                                        '/proc/typhon_log') ])),
       error(Formal) ]) :-
    no_leaks(log_server_start(Options, _)).
test(nothing_is_left_behind) :-
    no_leaks(( with_log([], Address, _, hundred(Address), _),
               garbage_collect,           % the queues of closed sessions
               garbage_collect_clauses,
               garbage_collect_atoms )).
test(events_without_a_log_server_are_reported_once,
     Messages == [no_log_server(missing, h)]) :-
    quietly(( arrives('missing@127.0.0.1:1', h, a, 1),
              arrives('missing@127.0.0.1:1', h, a, 2) ), Messages).
test(a_full_disk_is_reported_once,
     [ condition(exists_file_device('/dev/full')), true(Count == 1) ]) :-
    quietly(( log_server_start([file('/dev/full')], Address),
              hundred(Address),
              wait_until(printed(_), 5),
              hundred(Address),
              log_server_stop(Address) ), Messages),
    aggregate_all(count, member(log_not_written('/dev/full', _), Messages),
                  Count),
    assertion(memberchk(log_lost('/dev/full', 200), Messages)).
test(reason_is_printed_without_internals,
     [ condition(exists_file_device('/dev/full')),
       true(Text == "No space left on device") ]) :-
    quietly(( log_server_start([file('/dev/full')], Address),
              hundred(Address),
              log_server_stop(Address) ), Messages),
    memberchk(log_not_written(File, Error), Messages),
    phrase(prolog:message(typhon(log_not_written(File, Error))),
           [_-[File], _-[Reason]|_]), !,
    atom_string(Reason, Text).
test(events_lost_on_a_full_disk_are_counted,
     [ condition(exists_file_device('/dev/full')),
       true(Kept-Bad == [after]-[]) ]) :-
    with_tmp_dir(full_for_a_while(Kept, Bad)).

full_for_a_while(Kept, Bad, Dir) :-
    directory_file_path(Dir, link, Link),
    directory_file_path(Dir, real, Real),
    link_file('/dev/full', Link, symbolic),
    quietly(setup_call_cleanup(
                log_server_start([file(Link)], Address),
                fill_and_free(Address, Link, Real),
                log_server_stop(Address)), Messages),
    memberchk(log_written_again(_, Lost), Messages),
    Lost >= 100,
    quietly(log_events(Real, Events), Bad),
    findall(W, ( member(event(_, _, _, W), Events), W \== meanwhile ), Kept).
fill_and_free(Address, Link, Real) :-
    hundred(Address),
    wait_until(printed(log_not_written(_, _)), 5),
    forall(typhon_log_file:about_to_read(Link), true), % all writes were tried
    delete_file(Link),
    link_file(Real, Link, symbolic),
    wait_until(( arrives(Address, h, a, meanwhile),
                 printed(log_written_again(_, _)) ), 10),
    arrives(Address, h, a, after).

%   Root may write everywhere, by its capabilities: this process has none.

test(a_read_only_directory, [ condition(powerless('/usr/bin/true', [], [])),
                              true(Opened-Left == "open"-"none") ]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, events, File),
          chmod(Dir, -w),
          project_file(prolog, Library),
          current_prolog_flag(executable, Swipl),
          format(atom(Goal),
                 'assertz(file_search_path(library, ~q)),\c
                  use_module(library(typhon)),\c
                  catch(log_server_start([file(~q)], _),\c
                        error(permission_error(What, _, _), _), write(What)),\c
                  ( exists_file(~q) -> Left = some ; Left = none ),\c
                  write(Left), halt', [Library, File, File]),
          setup_call_cleanup(
              powerless(Swipl, ['-q', '-f', none, '-g', Goal],
                        [ stdout(pipe(Stream)),
                          environment(['TYPHON_COOKIE'=abcdefabcdefabcdef]) ]),
              read_string(Stream, _, Text),
              close(Stream)),
          chmod(Dir, +w),
          string_concat(Opened, Left, Text),
          string_length(Opened, 4) )).

%   powerless(+Program, +Args, +Options): fails if capabilities cannot be
%   dropped.

powerless(Program, Args, Options) :-
    without_capabilities(How),
    catch(process_create('/usr/bin/setpriv', [How, Program|Args],
                         [stderr(null), stdin(null)|Options]),
          error(_, _), fail).

without_capabilities('--bounding-set=-all') :-
    geteuid(0),
    !.
without_capabilities('--no-new-privs').

exists_file_device(File) :-
    access_file(File, write).

:- end_tests(log_server).

:- begin_tests(log_files).

%   file(-Text, -Then, -Numbers, -Skipped): the numbers that are read, and the
%   lines that are not, of a file with Text, to which a server with the options
%   Then writes the number 3, or none does.

file("event(1.0,h,a,1).\nevent(2.0,h,a,2).\nevent(3.0,h,", none, [1,2], [3]).
file("event(1.0,h,a,1).\nevent(3.0,'h", none, [1], [2]).
file("event(1.0,h,a,1).\nevent(2.0,h\nevent(3.0,h,a,3).\n", none, [1,3], [2]).
file("", none, [], []).
file("event(1.0,h,a,1).\nevent(2.0,h,", [mode(append)], [1,3], [2]).
file("event(1.0,h,a,1).\n", [mode(append)], [1,3], []).
file("event(1.0,h,a,1).\n", [], [3], []).

test(lines_that_are_cut_are_skipped,
     [ forall(file(Text, Then, Numbers, Skipped)),
       Ns-Lines == Numbers-Skipped ]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'events.pl', File),
          write_file(File, Text),
          (   Then == none
          ->  true
          ;   log_server_start([file(File)|Then], Address),
              arrives(Address, h, a, 3),
              log_server_stop(Address)
          ),
          quietly(log_events(File, Events), Printed) )),
    findall(N, member(event(_, _, _, N), Events), Ns),
    findall(Line, member(log_line_skipped(_:Line, _), Printed), Lines).
test(line_that_is_being_written_is_not_there_yet, Ns-Printed == [1]-[]) :-
    with_log([], Address, File,
             ( arrives(Address, h, a, 1),
               log_events(File, [_]),
               setup_call_cleanup(     % the writer's buffer ends in a line
                   open(File, append, Out),
                   write(Out, 'event(2.0,h,'),
                   close(Out)),
               quietly(log_events(File, Events), Printed) ), _),
    findall(N, member(event(_, _, _, N), Events), Ns).
test(no_such_file, error(existence_error(_, _))) :-
    log_events('/no/such/file', _).

:- end_tests(log_files).
