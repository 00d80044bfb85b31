:- module(test_cell_inmate,
          [ with_inmates/1,             % :Goal
            with_inmates/3,             % +Options, +Quotas, :Goal
            inmate/3,                   % +First, +Goal, -Clauses
            attempt/2,                  % +Goal, -Outcome
            through/2,                  % :Checks, -Through
            audited/1,                  % ?What
            target/2                    % ?Name, -Value
          ]).
:- use_module(common).
:- use_module(fixtures).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(socket)).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/cell), [cells_list/1]).

/** <module> Agents that have all rights inside their cell

The rules of the host c give such rights: they do not check what
call_with_depth_limit/3 calls. So an inmate calls any goal in the process of
its cell, including the predicates that communicate with the gatekeeper.

*Threading*: one test at a time.
*/

:- meta_predicate
    with_inmates(0),
    with_inmates(+, +, 0),
    in_cell(+, +, 0, +),
    through(:, -).

:- dynamic target/2.

%!  with_inmates(:Goal) is semidet.
%!  with_inmates(+Options, +Quotas, :Goal) is semidet.
%
%   Call Goal once while the host c has inmates, also with these options and
%   quotas.

with_inmates(Goal) :-
    with_inmates([], [seconds(60)], Goal).

with_inmates(Options, Quotas, Goal) :-
    with_tmp_dir(in_cell(Options, Quotas, Goal)).

in_cell(Options, Quotas, Goal, Dir) :-
    (   memberchk(policy(_), Options)
    ->  Policy = []
    ;   project_file('test/prolog/options/cell/rules.pl', Rules),
        Policy = [policy(Rules)]
    ),
    append(Policy, Options, Options1),
    directory_file_path(Dir, audit, Audit),
    setup_call_cleanup(
        bait_set(Dir, Sockets),
        with_hosts([c-[ cell(owner), audit(Audit), quota(Quotas)|Options1 ]],
                   ( baits_inside(A), call(Goal), rests(A) )),
        bait_clear(Sockets)).

%!  target(?Name, -Value) is nondet.
%
%   What an inmate tries to reach: `secret`, a file; `port` and `other`, where
%   this process listens; `pid` of this process; `cell`, of one that runs a
%   cell; `agent`, which rests on c; `audit`, the file.

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
    directory_file_path(Dir, audit, Audit),
    forall(member(Name-Value, [ secret-Secret, port-Port, other-Other, pid-Pid,
                                audit-Audit ]),
           assertz(target(Name, Value))).

baits_inside(A) :-
    cells_list([cell(_, Pid, _)|_]),
    agent_create(clauses([(:- agent(rests, [])), on_message(_, _)]), A,
                 [host(c)]),
    assertz(target(cell, Pid)),
    assertz(target(agent, A)).

%   A test may have stopped the host.

rests(A) :-
    (   catch(host_property(c, address(_)), error(_, _), fail)
    ->  wait_state(A, resident)
    ;   true
    ).

bait_clear(Sockets) :-
    retractall(target(_, _)),
    forall(member(Socket, Sockets), tcp_close_socket(Socket)).

%!  audited(?What) is nondet.
%
%   The audit of c has What.

audited(What) :-
    target(audit, File),
    exists_file(File),
    read_file_to_terms(File, Entries, []),
    member(audit(_, c, _, _, What), Entries).

                /*******************************
                *            INMATES           *
                *******************************/

%!  inmate(+First, +Goal, -Clauses) is det.
%
%   The program of an inmate that does First, and then calls Goal; its result is
%   yes(Goal), `no` or raised(Error).

inmate(First, Goal,
       [ (:- agent(escape, [state([goal/1])])),
         goal(Goal),
         helpers(Clauses),
         (main :- First, helpers(Cs), free(forall(member(C, Cs), assertz(C))),
                  goal(G), dare(G, R0),
                  free(typhon_fault:printable_fallback(R0, R)), result(R)),
         (dare(G, R) :- catch(( free(G) -> R = yes(G) ; R = no ), E,
                              R = raised(E))),
         (free(G) :- call_with_depth_limit(user:G, 1 000 000, _))
       ]) :-
    findall(Clause, helper(Clause), Clauses).

%!  attempt(+Goal, -Outcome) is det.
%
%   Outcome is of an inmate that calls Goal: its result, or else
%   ended(Outcome).  What the gatekeeper has seen of it is in the audit.

attempt(Goal, Outcome) :-
    inmate(true, Goal, Clauses),
    agent_create(clauses(Clauses), A, [host(c)]),
    agent_join(A, End, 300),
    (   End == done,
        catch(agent_result(A, Result, 5), error(existence_error(_, _), _), fail)
    ->  Outcome = Result
    ;   Outcome = ended(End)
    ),
    assertion(forall(is_seen(Outcome, A, What), audited(What))).

%   is_seen(+Outcome, +Agent, -What) is semidet.

is_seen(ended(lost(cell(Reason))), A, cell(A, Reason)).
is_seen(ended(raised(error(resource_error(What), _))), A, over(A, What)) :-
    memberchk(What, [cells, inferences, messages, seconds, state]).
is_seen(ended(raised(error(permission_error(call, sandboxed, _), _))), A,
        refused(A, policy(_))).
is_seen(yes(test_ask(_, raised(error(Formal, _)))), A, refused(A, policy(_))) :-
    subsumes_term(permission_error(call, sandboxed, _), Formal).

%   Clauses that are added to the program of an inmate.

helper((test_send(What) :- user:sends(What))).
helper((sends(frame(Term)) :-
           user:connection(_, Out),
           typhon_cell_frames:cell_frame_write(Out, Term))).
helper((sends(outcome_of(N, Outcome, Note, Changes)) :-
           user:sends(frame(outcome(N, Outcome, Note, Changes))))).
helper((sends(outcome(Outcome, Note, Changes)) :-
           user:turn(N),
           user:sends(frame(outcome(N, Outcome, Note, Changes))))).
helper((sends(turn_by(Step)) :-
           user:turn(N0), N is N0+Step,
           user:sends(outcome_of(N, done, none, [])))).
helper((sends(over(What)) :-
           user:turn(N),
           user:sends(frame(over(N, What))))).
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
helper((sends(endless(told)) :-
           user:turn(N),
           repeat, user:sends(frame(told(N, []))), fail)).
helper((sends(endless(requests)) :-
           user:turn(N),
           repeat, user:sends(frame(request(N, neighbours(_)))), fail)).
helper((sends(endless(asked)) :-
           repeat, user:test_ask(neighbours(_), _), fail)).
helper((sends(unfinished) :-
           user:sends(bytes([0,127,0,0])), repeat, sleep(10), fail)).
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
helper((sends(created(K)) :-
           forall(between(1, K, _),
                  user:test_ask(create(clauses([ (:- agent(escape, [])),
                                                 on_message(_, _) ]), _, []),
                                _)))).
helper((sends(last_words) :-
           user:turn(N), user:sends(frame(request(N, neighbours(_)))),
           halt)).
helper((sends(clones) :-
           user:turn(N),
           forall(between(1, 2, _),
                  user:sends(outcome_of(N, effect(clone(W), W, [sleep(60)]),
                                        none, []))))).
helper((sends(kept) :- user:turn(N), assertz(user:kept(N)))).
helper((sends(late) :-
           user:kept(N),
           user:sends(outcome_of(N, effect(clone(W), W, [sleep(60)]), none,
                                 [])))).
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
helper((test_see(Goals, Seen) :-
           findall(R, ( member(G, Goals),
                        ( catch(G, error(_, _), fail) -> R = yes ; R = no ) ),
                   Seen))).
helper((test_open_of(Pid, Name) :-
           atomic_list_concat(['/proc/',Pid,/,Name], File),
           open(File, read, _))).

                /*******************************
                *            CHECKS            *
                *******************************/

%!  through(:Checks, -Through) is det.
%
%   Through are those of Checks, Name-Goal-Expected, Name-Outcome, of which
%   something else is the outcome.  In Goal target(Name) stands for that.

through(Module:Checks, Through) :-
    findall(Name-Outcome,
            ( member(Name-Goal0-Expected, Checks),
              once(filled(Goal0, Goal)),
              attempt(Goal, Outcome),
              \+ as_expected(Expected, Module, Outcome) ),
            Through).

filled(Goal, Goal) :-
    var(Goal),
    !.
filled(target(Name), Value) :-
    !,
    target(Name, Value).
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

as_expected(Any, _, _) :-
    var(Any),
    !.
as_expected(A;_, Module, Outcome) :-
    as_expected(A, Module, Outcome),
    !.
as_expected(_;B, Module, Outcome) :-
    !,
    as_expected(B, Module, Outcome).
as_expected(raised(Formal), _, raised(error(Formal0, _))) :-
    !,
    Formal0 \= existence_error(procedure, _),
    subsumes_term(Formal, Formal0).
as_expected(answer(Expected), Module, yes(test_ask(_, Answer))) :-
    !,
    as_expected(Expected, Module, Answer).
as_expected(yes(Goal, Test), Module, yes(Goal)) :-
    !,
    call(Module:Test).
as_expected(Expected, _, Outcome) :-
    subsumes_term(Expected, Outcome).
