:- module(test_cell_escapes, []).
:- use_module('../../../lib/common').
:- needs([cells]).
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, subset/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(socket)).
:- use_module(library(typhon)).

/** <module> What an agent with all rights inside its cell cannot do

The rules of the host give such rights: what call_with_depth_limit/3 calls is
not looked at.  So the agent calls any goal in the process of its cell, also
the predicates by which that speaks to the gatekeeper.

*Threading*: one test at a time.
*/

:- dynamic bait/2.              % Name, Value: what the agent is to reach

%   attempt(+Goal, -Outcome): Outcome is of an agent that calls Goal: yes(Goal),
%   `no` or raised(Error), where it gave that as its result, or ended(Outcome).

attempt(Goal, Outcome) :-
    findall(Clause, helper(Clause), Clauses),
    agent_create(
        clauses([ (:- agent(escape, [state([goal/1])])),
                  goal(Goal),
                  helpers(Clauses),
                  (main :- helpers(Cs), free(forall(member(C, Cs), assertz(C))),
                           goal(G), dare(G, R0),
                           free(typhon_fault:in_words(R0, R)), result(R)),
                  (dare(G, R) :- catch(( free(G) -> R = yes(G) ; R = no ), E,
                                       R = raised(E))),
                  (free(G) :- call_with_depth_limit(user:G, 1 000 000, _))
                ]),
        A, [host(c)]),
    agent_join(A, End, 60),
    (   End == done,
        catch(agent_result(A, Result, 5), error(existence_error(_, _), _), fail)
    ->  Outcome = Result
    ;   Outcome = ended(End)
    ).

%   What the agent adds to the program of its cell.


helper((test_send(What) :- user:sends(What))).
helper((sends(frame(Term)) :-
           user:connection(_, Out),
           typhon_cell_frames:cell_frame_write(Out, Term))).
helper((sends(outcome_of(N, Outcome, Note, Changes)) :-
           user:sends(frame(outcome(N, Outcome, Note, Changes))))).
helper((sends(outcome(Outcome, Note, Changes)) :-
           user:turn(N),
           user:sends(frame(outcome(N, Outcome, Note, Changes))))).
helper((sends(text(Text)) :-
           string_length(Text, Length),
           B2 is Length>>16, B1 is Length>>8 /\ 255, B0 is Length /\ 255,
           user:sends(bytes([0,B2,B1,B0])),
           user:connection(_, Out),
           write(Out, Text), flush_output(Out))).
helper((sends(bytes(Bytes)) :-
           user:connection(_, Out),
           string_codes(Text, Bytes),
           write(Out, Text), flush_output(Out))).
helper((sends(record(Term)) :-
           fast_term_serialized(Term, Text),
           user:sends(text(Text)))).
helper((sends(digits(Before, Digits, N)) :-
           length(L, N), maplist(=(Digits), L), atomics_to_string(L, Text0),
           string_concat(Before, Text0, Text1), string_concat(Text1, ".", Text),
           user:sends(text(Text)))).
helper((sends(deep(N)) :-
           length(L, N), maplist(=('f('), L), atomics_to_string(L, Text),
           user:sends(text(Text)))).
helper((sends(told(Goals)) :-
           user:turn(N),
           user:sends(frame(told(N, Goals))))).
helper((sends(functors(K, Length)) :-
           forall(between(1, K, I),
                  ( findall(T, ( between(1, Length, J),
                                 atomic_list_concat([a_new,I,J], '_', Name),
                                 T =.. [Name,x] ), Ts),
                    user:sends(told([log(Ts)])) )))).
helper((sends(refused(K, Length)) :-
           length(List, Length),
           forall(between(1, K, _), user:test_ask(halt(List), _)))).
helper((sends(lacks(K)) :-
           user:turn(N),
           forall(between(1, K, _), user:sends(frame(lacks(N)))))).
helper((sends(twice) :-
           user:sends(outcome(done, none, [])),
           user:sends(outcome(done, none, [])))).
helper((test_ask(Goal, Answer) :-
           user:connection(In, Out), user:turn(N),
           typhon_cell_frames:cell_frame_write(Out, request(N, Goal)),
           typhon_cell_frames:cell_frame_read(In, answer(N, Answer)))).
helper((connection(In, Out) :-
           nb_getval(cell_connection, connection(In, Out)))).
helper((turn(N) :- b_getval(cell_turn, turn(N, _, _)))).

with_cell(Goal) :-
    with_tmp_dir(in_cell(Goal)).

:- meta_predicate with_cell(0), in_cell(0, +).

in_cell(Goal, Dir) :-
    project_file('test/prolog/options/cell/rules.pl', Rules),
    directory_file_path(Dir, audit, Audit),
    setup_call_cleanup(
        bait_set(Dir, Sockets),
        with_hosts([c-[ policy(Rules), cell(owner), audit(Audit),
                        quota([seconds(20)]) ]],
                   call(Goal)),
        bait_clear(Sockets)).

bait_set(Dir, [Inet,Unix]) :-
    directory_file_path(Dir, secret, Secret),
    setup_call_cleanup(open(Secret, write, Out), writeln(Out, secret),
                       close(Out)),
    tcp_socket(Inet),
    tcp_bind(Inet, '127.0.0.1':Port),
    tcp_listen(Inet, 5),
    directory_file_path(Dir, other, Other),
    unix_domain_socket(Unix),
    tcp_bind(Unix, Other),
    tcp_listen(Unix, 5),
    current_prolog_flag(pid, Pid),
    forall(member(Name-Value, [ secret-Secret, port-Port, other-Other, pid-Pid,
                                audit-Dir ]),
           assertz(bait(Name, Value))).

bait_clear(Sockets) :-
    retractall(bait(_, _)),
    forall(member(Socket, Sockets), tcp_close_socket(Socket)).

filled(Goal, Goal) :-
    var(Goal),
    !.
filled(bait(Name), Value) :-
    !,
    bait(Name, Value).
filled(Goal0, Goal) :-
    compound(Goal0),
    !,
    Goal0 =.. [Name|Args0],
    filled_all(Args0, Args),
    Goal =.. [Name|Args].
filled(Goal, Goal).

filled_all([], []).
filled_all([Arg0|Args0], [Arg|Args]) :-
    filled(Arg0, Arg),
    filled_all(Args0, Args).

%   through(+Checks, -Through): those of Checks, Name-Goal-Expected, of which
%   something else is the outcome.

through(Kind, Through) :-
    findall(Name-Outcome,
            ( check(Kind, Name, Goal0, Expected),
              once(filled(Goal0, Goal)),
              attempt(Goal, Outcome),
              \+ as_expected(Expected, Outcome) ),
            Through).

as_expected(Any, _) :-
    var(Any),
    !.
as_expected(A;_, Outcome) :-
    as_expected(A, Outcome),
    !.
as_expected(_;B, Outcome) :-
    !,
    as_expected(B, Outcome).
as_expected(raised(Formal), raised(error(Formal0, _))) :-
    !,
    subsumes_term(Formal, Formal0).
as_expected(yes(Goal, Test), yes(Goal)) :-
    !,
    call(Test).
as_expected(Expected, Outcome) :-
    subsumes_term(Expected, Outcome).

:- begin_tests(cell_escapes).

test(nothing_of_the_system_is_reached, Through == []) :-
    with_cell(through(system, Through)).
test(no_frame_deceives_the_gatekeeper, Through == []) :-
    with_cell(through(frame, Through)).
test(refused_requests_are_audited, Left == []) :-
    with_cell(unaudited(Left)).
test(requests_that_are_refused_do_not_fill_the_audit,
     [Outcome,Lines] = [ended(lost(cell(violation(refused)))),102]) :-
    with_cell(refused_again_and_again(Outcome, Lines)).
test(no_act_without_an_answer_passes_the_rules, Through == []) :-
    with_cell(through(act, Through)).
test(new_functors_are_charged_to_the_owner_until_its_turns_end,
     [First,Next,Before,After,Lines] =
     [ended(lost(cell(violation(functors)))),ended(lost(cell(violation(functors)))),
      true,true,2]) :-
    with_settings([typhon_cells:functors=30 000],
                  with_cell(functors_charged([First,Next], Before, After,
                                             Lines))).
test(what_comes_after_the_outcome_ends_the_cell,
     [One,Next,After] = [ended(done), ended(lost(cell(violation(frame)))),
                         yes(true)]) :-
    with_cell(maplist(attempt, [test_send(twice), true, true],
                      [One,Next,After])).
test(no_request_passes_the_rules, Through == []) :-
    with_cell(through(request, Through)).

:- end_tests(cell_escapes).

%   Each is large.

refused_again_and_again(Outcome, Lines) :-
    bait(audit, Dir),
    directory_file_path(Dir, audit, Audit),
    attempt(test_send(refused(150, 600)), Outcome),
    read_file_to_terms(Audit, Entries, []),
    length(Entries, Lines),
    size_file(Audit, Size),
    assertion(Size < 100 000).

%   The cell writes frames of 5,000 new functors until it is ended; an agent of the
%   same owner has no turn then.  Before: not all came; After: the process has few more.

functors_charged([First,Next], Before, After, Lines) :-
    bait(audit, Dir),
    directory_file_path(Dir, audit, Audit),
    statistics(functors, Count0),
    attempt(test_send(functors(20, 5 000)), First),
    statistics(functors, Count1),
    ( Count1-Count0 < 50 000 -> Before = true ; Before = Count1-Count0 ),
    attempt(true, Next),
    statistics(functors, Count2),
    ( Count2-Count1 < 1000 -> After = true ; After = Count2-Count1 ),
    read_file_to_terms(Audit, Entries, []),
    findall(x, member(audit(_, c, _, _, cell(_, violation(functors))), Entries),
            Xs),
    length(Xs, Lines).

unaudited(Left) :-
    bait(audit, Dir),
    directory_file_path(Dir, audit, Audit),
    attempt(test_ask(halt, _), _),
    attempt(test_send(frame(nonsense)), _),
    read_file_to_terms(Audit, Entries, []),
    findall(What,
            ( member(What, [refused(_, policy(halt)),
                            cell(_, violation(_))]),
              \+ member(audit(_, c, _, _, What), Entries) ),
            Left).

                /*******************************
                *           THE SYSTEM         *
                *******************************/

only_what_is_mounted(Names) :-
    current_prolog_flag(home, Home),
    atomic_list_concat(['',Top|_], /, Home),
    subset(Names, [Top,.,..,bin,dev,etc,lib,lib64,proc,tmp,typhon,usr]).

%   check(?Kind, ?Name, -Goal, -Expected)

check(system, 'descriptors', directory_files('/proc/self/fd', L),
      yes(directory_files(_, L), subset(L, [.,..,'0','1','2','3','4']))).
check(system, 'a shell',
      ( catch(shell('echo > /tmp/made'), _, true), exists_file('/tmp/made') ),
      no).
check(system, 'a process', process_create('/usr/bin/prlimit', [], []),
      raised(_)).
check(system, 'a fork', ( fork(Pid), Pid \== child ), raised(_)).
check(system, 'files of the system', open('/etc/passwd', read, _),
      raised(existence_error(_, _))).
check(system, 'a file of the gatekeeper', open(bait(secret), read, _),
      raised(existence_error(_, _))).
check(system, 'what is in /', directory_files(/, L),
      yes(directory_files(_, L), only_what_is_mounted(L))).
check(system, 'to change the library', open('/typhon/x', write, _),
      raised(permission_error(_, _, _))).
check(system, 'to fill the disk',
      ( open('/tmp/big', write, S),
        forall(between(1, 40000, _), format(S, "~`xt~1000|~n", [])),
        close(S) ), raised(_)).
check(system, 'shared memory', open('/dev/shm/x', write, _),
      raised(permission_error(_, _, _))).
check(system, 'a port of the host', tcp_connect('127.0.0.1':bait(port), _, []),
      raised(socket_error(econnrefused, _))).
check(system, 'the internet', tcp_connect('192.0.2.1':80, _, []),
      raised(socket_error(enetunreach, _))).
check(system, 'a name server', tcp_host_to_address('example.org', _),
      raised(_)).
check(system, 'a Unix socket of the host',
      ( unix_domain_socket(S), tcp_connect(S, bait(other)) ), raised(_)).
check(system, 'other processes',
      ( directory_files('/proc', L),
        findall(N, ( member(X, L), atom_number(X, N) ), Ns) ),
      yes(( _, findall(_, _, Ns) ), ( length(Ns, C), C =< 2 ))).
check(system, 'process 1 is this one', current_prolog_flag(pid, P),
      yes(current_prolog_flag(_, P), P == 1)).
check(system, 'to kill the gatekeeper', process_kill(bait(pid), kill),
      raised(_)).
check(system, 'memory of another process',
      open('/proc/2/mem', read, _), raised(_)).
check(system, 'the environment', environ(_),
      yes(environ(L), \+ memberchk('TYPHON_COOKIE'=_, L))).
check(system, 'a hundred threads',
      ( set_prolog_flag(threads, true),
        forall(between(1, 100, _),
               thread_create(sleep(2), _, [detached(true)])) ),
      raised(_) ; ended(_)).
check(system, 'more memory', rlimit(as, _, unlimited), raised(_)).
check(system, 'more processes', rlimit(nproc, _, 100000), raised(_)).
check(system, 'larger files', rlimit(fsize, _, unlimited), raised(_)).
check(system, 'to live for ever',
      ( open('/proc/self/oom_score_adj', write, S), write(S, '-1000'),
        close(S) ), raised(_)).
check(system, 'the kernel', open('/proc/sys/kernel/core_pattern', write, _),
      raised(_)).
check(system, 'users of the namespace',
      ( open('/proc/self/uid_map', write, S), write(S, '0 0 1\n'), close(S) ),
      raised(_)).
check(system, 'devices', open('/dev/kmsg', read, _),
      raised(existence_error(_, _))).
check(system, '/sys', open('/sys/class/net', read, _),
      raised(existence_error(_, _))).
check(system, 'a foreign library of its own',
      ( open('/tmp/x.so', write, S), write(S, x), close(S),
        use_foreign_library('/tmp/x.so') ), raised(_)).
check(system, 'the root of process 1', open('/proc/1/root/etc/passwd', read, _),
      raised(existence_error(_, _))).
check(system, 'all memory',
      ( set_prolog_flag(stack_limit, 16000000000), length(L, 200000000),
        L = [a|_] ), raised(resource_error(_)) ; ended(_)).
check(system, 'to end the process', halt, ended(lost(cell(exit(0))))).

                /*******************************
                *            FRAMES            *
                *******************************/

%   The helpers above write what there is no predicate for.

check(frame, Name, test_send(What), ended(lost(cell(Reason)))) :-
    frame(Name, What, Reason).
check(request, Name, test_ask(Goal, Answer), Expected) :-
    request(Name, Goal, Expected0),
    (   nonvar(Expected0),
        Expected0 = ended(_)
    ->  Expected = Expected0
    ;   Expected = yes(test_ask(_, Answer), as_expected(Expected0, Answer))
    ).

check(act, Name, test_send(told([log(1),Goal,log(2)])),
      ended(raised(error(permission_error(call, sandboxed, _), _)))) :-
    request(Name, Goal, Expected),
    refused(Refused),
    Expected =@= Refused.
check(act, 'an answer', test_send(told([sense(_)])),
      ended(raised(error(permission_error(call, sandboxed, sense(_)), _)))).

frame('no term', text("garbage("), violation(syntax_error(_))).
frame('more than a term', text("told(0,[]). told(0,[])."),
      violation(syntax_error(end_of_file_expected))).
frame('a term and half of another', text("told(0,[]). told("),
      violation(syntax_error(end_of_file_expected))).
frame('a term and a comment', text("told(0,[]). % x"),
      violation(syntax_error(end_of_file_expected))).
frame('a term and a byte that is none', text("told(0,[]).\n\000\"),
      violation(syntax_error(end_of_file_expected))).
frame('nothing', text(""), violation(syntax_error(no_term))).
frame('a comment alone', text("% x"), violation(syntax_error(no_term))).
frame('an end that is none', text("end_of_file."),
      violation(syntax_error(no_term))).
frame('no end', bytes([0,0,0,9,0'a]), violation(_)).
frame('longer than any', bytes([255,255,255,255]),
      violation(syntax_error(frame_too_large))).
frame('a record', record(outcome(0, done, none, [])), violation(_)).
frame('half a record', text("\u0083\u0003\u0001"), violation(_)).
frame('too deep', deep(200 000), violation(_)).
frame('a number of many digits', digits("f(a7,", '7', 200 000),
      violation(syntax_error(long_number))).
frame('of base 36', digits("36'", 'z', 100 000),
      violation(syntax_error(long_number))).
frame('of digits with blanks between', digits("", '7 7', 100 000),
      violation(syntax_error(long_number))).
frame('another frame', frame(nonsense), violation(frame)).
frame('a variable', frame(_), violation(frame)).
frame('another turn', outcome_of(-1, done, none, []), violation(frame)).
frame('a turn that is a variable', outcome_of(_, done, none, []),
      violation(frame)).
frame('a request of another turn', frame(request(0, true)), violation(frame)).
frame('an outcome that there is not', outcome(over(seconds), none, []),
      violation(frame)).
frame('to be lost', outcome(lost(x), none, []), violation(frame)).
frame('held', outcome(held, none, []), violation(frame)).
frame('an abort', outcome(raised('$aborted'), none, []), violation(frame)).
frame('an unwinding', outcome(raised(unwind(halt(1))), none, []),
      violation(frame)).
frame('a control that is none', outcome(effect(halt, H, [H]), none, []),
      violation(frame)).
frame('a qualified control', outcome(effect(user:halt, H, [H]), none, []),
      violation(frame)).
frame('a control that is a variable', outcome(effect(_, H, [H]), none, []),
      violation(frame)).
frame('a fault made up', outcome(effect('$fault'(x), H, [H]), none, []),
      violation(frame)).
frame('a fault among its goals',
      outcome(effect(sleep(0), H, [H,'$fault'(x)]), none, []),
      violation(frame)).
frame('a hole that is bound', outcome(effect(sleep(0), halt, []), none, []),
      violation(frame)).
frame('goals that are no list', outcome(effect(sleep(0), H, [H|x]), none, []),
      violation(frame)).
frame('a list without end', outcome(effect(sleep(0), H, [H|_]), none, []),
      violation(frame)).
frame('goals that are none', outcome(effect(sleep(0), H, [H,1]), none, []),
      violation(frame)).
frame('a time that is none',
      outcome(effect(sleep_until(x), H, [H]), none, []), violation(frame)).
frame('changes that are no list', outcome(done, none, x), violation(frame)).
frame('a change that is none', outcome(done, none, [x]), violation(frame)).
frame('another owner', outcome(done, none, ['$owner'/1-['$owner'(root)]]),
      violation(_)).
frame('a result of its own',
      outcome(done, none, ['$legacy'/1-['$legacy'(result(1))]]), violation(_)).
frame('a memory that is a rule',
      outcome(done, none, ['$memory'/1-[('$memory'(_) :- halt)]]),
      violation(_)).
frame('clauses of another predicate', outcome(done, none, [goal/1-[other(1)]]),
      violation(frame)).
frame('a clause of a module',
      outcome(done, none, [goal/1-[(user:goal(1) :- halt)]]), violation(_)).
frame('a directive', outcome(done, none, [goal/1-[(:- halt)]]), violation(_)).
frame('a rule that the policy refuses',
      outcome(done, none, [goal/1-[(goal(_) :- shell(ls))]]), violation(_)).
frame('a predicate of the system',
      outcome(done, none, [halt/0-[halt]]), violation(_)).
frame('an arity that is none',
      outcome(done, none, [goal/(-1)-[]]), violation(frame)).
frame('an arity without end',
      outcome(done, none, [goal/100 000 000-[]]), violation(frame)).
frame('a name that is none', outcome(done, none, ["goal"/1-[]]),
      violation(frame)).
frame('acts that are no list', told(x), violation(frame)).
frame('an act that is none', told([1]), violation(frame)).
frame('an act that is a variable', told([_]), violation(frame)).
frame('to lack what it has, again and again', lacks(3), violation(frame)).

                /*******************************
                *           REQUESTS           *
                *******************************/

refused(raised(permission_error(call, sandboxed, _))).

request(Name, Goal, Expected) :-
    refused(Refused),
    member(Name-Goal,
           [ 'a goal of the system'-halt,
             'a shell'-shell(ls),
             'a goal of a module'-(user:halt),
             'a conjunction'-(self(_), halt),
             'a call'-call(halt),
             'all solutions'-findall(x, halt, _),
             'a goal that waits'-freeze(_, halt),
             'to deliver'-deliver(x),
             'to move a file'-attach('/etc/passwd'),
             'a payload elsewhere'-attach(payloads('../../etc/passwd')),
             'a payload by a list'-attach([payload(x)]),
             'a control predicate'-move(a),
             'another agent'-agent_send(a, b),
             'to end a host'-host_stop(c),
             'a private predicate'-'$set_source_module'(user),
             'a hook'-'typhon_gate:gate'(a, b, c, d)
           ]),
    Expected = Refused.
request('a goal that is none', 1, ended(lost(cell(violation(frame))))).
request('a recipient of a bridge', send(fipa(x, []), hello), raised(_)).
request('a recipient that is none', send("x", hello), raised(_)).
request('a payload that is not attached', detach(x), raised(_)).
request('a strategy that is none', next_host(halt, _), _).
request('a fact that calls', ( sense(user:halt) ), _).
