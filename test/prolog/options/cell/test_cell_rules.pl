:- module(test_cell_rules, []).
:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/guard), []).
:- use_module(library(typhon/options/cell), []).
:- use_module(library(typhon/options/cell/cell_acts),
              [ cell_changes_made/3, cell_fault/3, cell_outcome/1,
                cell_turn_begins/0 ]).
:- use_module(library(typhon/options/cell/cell_frames),
              [ cell_frame_read/2, cell_frame_text/2, cell_frame_write/2,
                cell_state/2, cell_text_term/2, cell_word/2, state_changes/3,
                state_mark/2 ]).
:- use_module(library(typhon/options/cell/cell_functors),
              [functors_charged/3, functors_left/1]).

/** <module> What the gatekeeper takes from a cell, without cells

*Threading*: one test at a time.
*/

                /*******************************
                *            FRAMES            *
                *******************************/

%   frame_of(+Bytes, -Result): Result is the text of the frame, `end`, or the
%   error.

frame_of(Bytes, Result) :-
    setup_call_cleanup(
        ( string_codes(String, Bytes), open_string(String, In) ),
        catch(( cell_frame_text(In, Text) -> Result = Text ; Result = end ),
              error(Result, _), true),
        close(In)).

long(Length, Bytes) :-
    B3 is Length>>24, B2 is Length>>16 /\ 255, B1 is Length>>8 /\ 255,
    B0 is Length /\ 255,
    Width is 4+Length,
    format(string(Bytes), "~s~`xt~*|", [[B3,B2,B1,B0], Width]).

:- begin_tests(cell_frame_bounds).

test(frames_are_counted_in_bytes, Results == ["", "abc", end, end]) :-
    maplist(frame_of, [ [0,0,0,0], [0,0,0,3,0'a,0'b,0'c,0'd], [], [0,0] ],
            Results0),
    findall(R, ( member(R0, Results0),
                 ( string(R0) -> R = R0 ; R = end ) ), Results).
test(truncated_frame_is_an_error, Result == syntax_error(truncated_frame)) :-
    frame_of([0,0,0,3,0'a,0'b], Result).
test(longest_frame_has_eight_million_bytes,
     Results == [8 388 608,syntax_error(frame_too_large)]) :-
    findall(R, ( member(N, [8 388 608,8 388 609]), long(N, Bytes),
                 frame_of(Bytes, R0),
                 ( string(R0) -> string_length(R0, R) ; R = R0 ) ), Results).
test(longest_frame_is_written,
     Results == [ok,resource_error(cell_frame)]) :-
    written("", ok, Around),
    Most is 8 388 608-Around,
    findall(R, ( member(More, [0,1]), N is Most+More,
                 format(string(Text), "~`-t~*|", [N]), written(Text, R, _) ),
            Results).
test(frame_is_read_as_it_was_written,
     [forall(member(Term, [ ready, told(1, [log("ä")]), f(X, _, X), 'a b'(1.5),
                            "", [], 1r3 ])), Read =@= Term]) :-
    with_output_to(string(Text), cell_frame_write(current_output, Term)),
    setup_call_cleanup(
        open_string(Text, In),
        ( cell_frame_read(In, Read), cell_frame_read(In, End) ),
        close(In)),
    assertion(End == end_of_file).
test(numbers_have_less_than_thirty_thousand_digits,
     Results == [read,read,syntax_error(long_number)]) :-
    findall(R, ( member(N, [100,14 999,30 000]),
                 Width is N+1,
                 format(string(Bytes), "[~`7t~*|].", [Width]),
                 catch(( cell_text_term(Bytes, _), R = read ), error(R, _),
                       true) ), Results).
test(text_of_no_term_is_an_error,
     [forall(member(Text, ["", " ", "% x", "end_of_file"])),
      error(syntax_error(_))]) :-
    cell_text_term(Text, _).

:- end_tests(cell_frame_bounds).

%   written(+Text, -Result, -Length): Length is that of the frame of Text.

written(Text, Result, Length) :-
    with_output_to(string(Frame),
                   catch(( cell_frame_write(current_output, Text),
                           Result = ok ), error(Result, _), true)),
    string_length(Frame, Length0),
    Length is Length0-4.

                /*******************************
                *           OUTCOMES           *
                *******************************/

control(Goal) :-
    member(Goal,
           [ move(x), clone(_), clone(_, []), sleep(1), sleep_until(1.5),
             receive(_), receive(_, 1), receive_until(_, 1, 2), dispose ]).

no_outcome(Term) :-
    member(Term,
           [ held, over(x), raised(_), raised('$aborted'), raised(unwind(x)),
             effect(move(x), h, []), effect(_, _, []), effect(halt, _, []),
             effect('$fault'(x), _, []), effect(user:move(x), _, []),
             effect(move(x, y, z), _, []), effect(sleep_until(x), _, []),
             effect(sleep_until(_), _, []),
             effect(receive_until(_, x, _), _, []),
             effect(receive_until(_, 1), _, []), effect(move(x), _, x),
             effect(move(x), _, [x|_]), effect(move(x), _, [1]),
             effect(move(x), _, [a,'$fault'(x)]) ]).

:- begin_tests(cell_results).

test(outcomes_are_taken, Refused == []) :-
    findall(O, ( ( member(O, [ done, failed, raised(x), raised(error(a, b)) ])
                 ; control(C), O = effect(C, _, [_,a,b(1)]) ),
                 \+ cell_outcome(O) ), Refused).
test(other_terms_are_no_outcomes, Taken == []) :-
    findall(O, ( no_outcome(O), cell_outcome(O) ), Taken).
test(faults_are_those_of_the_outcome, Faults == [Fault,Known,none,none,none]) :-
    Fault = failed-fault(g, [a], natives(r, [])),
    Known = failed-fault(g, unknown, natives(r, [])),
    findall(F, ( member(Note, [ note(failed, fault(g, [a], natives(r, []))),
                                note(failed, fault(g, unknown, natives(r, []))),
                                note(raised, fault(g, [a], natives(r, []))),
                                note(failed, fault(g, x, natives(r, []))),
                                note(failed, fault(g, [a], natives(r, [c]))) ]),
                 cell_fault(Note, failed, F) ), Faults).
test(changes_are_of_the_state, Results == [yes,yes,yes,yes]) :-
    findall(R, ( member(C, [ [], [s/1-[s(1),s(2)]], [s/1-[]],
                             [s/1-[(s(X) :- r(X))],r/1-[r(1)]] ]),
                 change(C, R) ), Results).
test(other_changes_are_refused,
     [forall(member(C, [ x, [x], [s/1], [s/1-x], ["s"/1-[]], [s/x-[]],
                         [s/(-1)-[]], [s/256-[]], [s/1-[r(1)]], [s/1-[_]],
                         [s/1-[s(1,2)]], [s/1-[(user:s(1) :- true)]],
                         [s/1-[s(1)|_]], _ ])), Result == no]) :-
    change(C, Result).
test(clauses_of_predicates_are_replaced, Facts == [3]) :-
    with_agent(M, ( cell_changes_made([s/1-[s(1),s(2)]], h, M),
                    cell_changes_made([s/1-[s(3)]], h, M),
                    findall(X, M:s(X), Facts) )).
test(hundred_refusals_are_answered_and_no_more, Count == 100) :-
    cell_turn_begins,
    catch(( between(1, inf, N),
            flag(test_cell_refused, _, N),
            typhon_cell_acts:count_refusal,
            fail ),
          error(cell_violation(refused), _), true),
    flag(test_cell_refused, Last, Last),
    Count is Last-1.
test(each_turn_counts_refusals_anew) :-
    cell_turn_begins,
    forall(between(1, 100, _), typhon_cell_acts:count_refusal),
    cell_turn_begins,
    typhon_cell_acts:count_refusal.
test(ten_thousand_solutions_are_answered_and_no_more,
     Answers == [10 000,resource_error(solutions)]) :-
    findall(A, ( member(N, [10 000,10 001]),
                 catch(( typhon_cell_acts:solutions(acts, between(1, N, _),
                                                    user, solutions(Gs)),
                         length(Gs, A) ), error(A, _), true) ), Answers).
test(call_without_an_answer_has_none, Answer == solutions([])) :-
    typhon_cell_acts:solutions(tells, member(_, [1,2]), user, Answer).
test(words_are_asked_in_their_way, Asked == Expected) :-
    findall(Kind-PI,
            ( member(Kind, [acts,changes,tells,looks,fixed]),
              member(PI, [send/2,sense/1,self/1,create/3,attach/1,bogus/1]),
              typhon_cell_acts:may_ask(Kind, h, PI, vocabulary) ),
            Asked0),
    sort(Asked0, Asked),
    findall(Kind-PI,
            ( member(PI, [send/2,sense/1,self/1,create/3,attach/1]),
              cell_word(Kind0, PI),
              ( Kind = Kind0
              ; memberchk(Kind0, [fixed,tells,looks]), Kind = acts ) ),
            Expected0),
    sort(Expected0, Expected).
test(platform_keeps_its_facts, State == state([s/1], [s(1),(s(X) :- r(X))])) :-
    X = x,
    cell_state(state([s/1,'$owner'/1],
                     [s(1),'$owner'(root),(s(x) :- r(x)),
                      ('$memory'(_) :- true)]), State).
test(changes_since_a_mark_are_sent, Changes == [[],[s/1-[s(1)]],[r/1-[]]]) :-
    with_agent(M, ( state_mark(M, A), changes(M, A, C1),
                    assertz(M:s(1)), changes(M, A, C2),
                    assertz(M:r(1)), assertz(M:'$owner'(x)),
                    state_mark(M, B),
                    retractall(M:r(_)), changes(M, B, C3) )),
    Changes = [C1,C2,C3].

:- end_tests(cell_results).

changes(Module, Mark, Changes) :-
    state_changes(Module, Mark, Changes).

:- meta_predicate with_agent(-, 0).

with_agent(Module, Goal) :-
    Module = test_cell_agent,
    set_module(Module:class(temporary)),
    setup_call_cleanup(
        dynamic([Module:s/1,Module:r/1]),
        once(Goal),
        '$destroy_module'(Module)).

change(Changes, Result) :-
    with_agent(M, ( catch(cell_changes_made(Changes, h, M), error(_, _), fail)
                  -> Result = yes ; Result = no )).

                /*******************************
                *           FUNCTORS           *
                *******************************/

:- begin_tests(cell_functors, [cleanup(forget_functors)]).

test(functors_of_the_setting_are_charged_to_their_owner,
     Results == [left,left,ended,left]) :-
    with_settings([typhon_cells:functors=11],   % with that of lists
                  ( charged(one, 1, 6, R1), charged(one, 7, 10, R2),
                    charged(one, 11, 11, R3), charged(two, 12, 12, R4) )),
    Results = [R1,R2,R3,R4].
test(functor_is_charged_once, Count == 6) :-
    charged(again, 21, 25, _),
    charged(again, 21, 25, _),
    typhon_cell_functors:count(again, Count).
test(owner_has_one_count, Counts = [_]) :-
    charged(many, 31, 40, _),
    findall(C, typhon_cell_functors:count(many, C), Counts).
test(all_parts_are_charged, Count == 4) :-
    functors_charged(parts, "[f101(f102(x), [f103(y)|f104(z)])].", _),
    findall(N, ( typhon_cell_functors:charged(N, _, parts),
                 sub_atom(N, 0, _, _, f10) ), Ns),
    length(Ns, Count).
test(declared_predicates_are_charged, Names == [f201,f202]) :-
    functors_charged(declared,
                     "request(1,create(c([/(f201,1),/(f202,2)]),x,y)).", _),
    findall(N, ( typhon_cell_functors:charged(N, A, declared), A > 0,
                 sub_atom(N, 0, _, _, f20) ), Ns),
    sort(Ns, Names).
test(text_that_is_no_term_is_charged, [true(Count >= 2)]) :-
    catch(functors_charged(broken, "f301(f302(x)). g(", _), error(_, _), true),
    typhon_cell_functors:count(broken, Count).

:- end_tests(cell_functors).

%   charged(+Owner, +From, +To, -Result): a frame with the new functors From to
%   To comes from a cell of Owner.

charged(Owner, From, To, Result) :-
    numlist(From, To, Ns),
    findall(Part, ( member(N, Ns),
                    format(string(Part), "~w_~d(x)", [Owner,N]) ),
            Parts),
    atomic_list_concat(Parts, ',', List),
    format(string(Text), "[~w].", [List]),
    catch(functors_charged(Owner, Text, _), error(cell_violation(functors), _),
          true),
    ( functors_left(Owner) -> Result = left ; Result = ended ).

forget_functors :-
    retractall(typhon_cell_functors:charged(_, _, _)),
    retractall(typhon_cell_functors:count(_, _)).

                /*******************************
                *             POOL             *
                *******************************/

:- meta_predicate with_pool(+, 0).

%   with_pool(+Facts, :Goal): the tables of the pool have Facts.

with_pool(Facts, Goal) :-
    setup_call_cleanup(
        forall(member(Fact, Facts), assertz(typhon_cells:Fact)),
        once(Goal),
        forall(member(Table, [ process(_, _, _, _, _), spare(_), bound(_, _),
                               idle(_, _), waits(_, _, _, _), woken(_, _),
                               knows(_, _, _) ]),
               retractall(typhon_cells:Table))).

cell(N, process(N, pid, in, out, err)).

:- begin_tests(cell_pool).

test(only_idle_cells_of_the_key_are_taken, Taken == [1,none,none,none]) :-
    with_pool([ bound(1, k), idle(1, 0), bound(2, k), bound(3, l), spare(4) ],
              ( typhon_cells:take(k, a, C1), typhon_cells:take(k, a, C2),
                typhon_cells:take(l, a, C3), typhon_cells:take(m, a, C4) )),
    Taken = [C1,C2,C3,C4].
test(agent_that_takes_a_cell_is_not_awaited, Woken == [b]) :-
    with_pool([bound(1, k), idle(1, 0), woken(a, k), woken(b, l)],
              ( typhon_cells:take(k, a, _),
                findall(A, typhon_cells:woken(A, _), Woken) )).
test(first_that_waits_comes_first, Nexts == [run(h, a),none]) :-
    with_pool([bound(1, k), idle(1, 0), waits(k, 0, h, a), waits(k, 1, h, b)],
              ( typhon_cells:next_of(k, N1), typhon_cells:next_of(k, N2) )),
    Nexts = [N1,N2].
test(busy_cells_are_waited_for, Next == none) :-
    with_pool([bound(1, k)], typhon_cells:wait(k, h, a, Next)).
test(cell_is_wanted_for_a_key_without_one, Nexts == [wanted,none]) :-
    with_pool([bound(1, k), idle(1, 0)],
              ( typhon_cells:wait(l, h, a, N1), typhon_cells:next_of(m, N2) )),
    Nexts = [N1,N2].
test(returned_cell_serves_the_next_that_waits, Next == run(h, a)) :-
    with_pool([bound(1, k), waits(k, 0, h, a)], typhon_cells:give(1, Next)).
test(returned_cell_makes_way_for_another_key, Next == wanted) :-
    with_pool([bound(1, k), waits(l, 0, h, a)], typhon_cells:give(1, Next)).
test(ended_cell_is_not_returned, Next-Idle == none-[]) :-
    with_pool([], ( typhon_cells:give(1, Next),
                    findall(C, typhon_cells:idle(C, _), Idle) )).
test(agent_that_left_does_not_keep_others_waiting, Nexts == [run(h, b),none]) :-
    with_pool([ bound(1, k), idle(1, 0), woken(a, k), waits(k, 0, h, b),
                waits(k, 1, h, c) ],
              ( typhon_cells:left(a, N1), typhon_cells:left(c, N2),
                assertion(\+ typhon_cells:waits(_, _, _, c)) )),
    Nexts = [N1,N2].
test(new_cell_is_bound_to_a_key_without_one, Bound-Spare == [1-k]-[]) :-
    with_pool([spare(1), waits(k, 0, h, a)],
              ( typhon_cells:bind_spare(Next),
                assertion(Next == run(h, a)),
                findall(C-K, typhon_cells:bound(C, K), Bound),
                findall(C, typhon_cells:spare(C), Spare) )).
test(bound_cell_is_bound_to_no_other_key, [fail]) :-
    with_pool([bound(1, k), idle(1, 0), waits(l, 0, h, a)],
              typhon_cells:bind_spare(_)).
test(no_more_cells_than_the_setting, Below == [yes,no]) :-
    cell(1, P1),
    cell(2, P2),
    with_settings([typhon_cells:cells=2],
                  findall(B, ( member(Ps, [[P1],[P1,P2]]),
                               with_pool(Ps, ( typhon_cells:below_most
                                             -> B = yes ; B = no )) ), Below)).
test(cell_that_is_idle_longest_ends_first, Cell == 2) :-
    with_pool([ bound(1, k), idle(1, 5), bound(2, l), idle(2, 3), bound(3, m),
                idle(3, 1), woken(a, m) ], typhon_cells:oldest_idle(Cell)).
test(cell_ends_when_it_is_idle_for_longer_than_the_setting, Cells == [1]) :-
    typhon_cells:monotonic_time(Now),
    Long is Now-61,
    Short is Now-40,
    with_pool([idle(1, Long), idle(2, Short)],
              findall(C, typhon_cells:idle_long(C), Cells)).
test(nothing_is_known_of_an_ended_cell, Known == []) :-
    cell(1, P),
    with_pool([P, spare(1), bound(1, k), idle(1, 0)],
              ( typhon_cells:cell_learns(1, x, y),
                assertion(typhon_cells:cell_knows(1, x, y)),
                typhon_cells:forget_cell(1, _),
                typhon_cells:cell_learns(1, x, y),
                findall(F, ( member(F, [ process(1, _, _, _, _), spare(1),
                                         bound(1, _), idle(1, _),
                                         knows(1, _, _) ]),
                             call(typhon_cells:F) ), Known) )).
test(last_that_was_sent_is_known, Values == [2]) :-
    cell(1, P),
    with_pool([P], ( typhon_cells:cell_learns(1, x, 1),
                     typhon_cells:cell_learns(1, x, 2),
                     findall(V, typhon_cells:cell_knows(1, x, V), Values),
                     typhon_cells:cell_forgets(1, x),
                     assertion(\+ typhon_cells:cell_knows(1, x, _)) )).

:- end_tests(cell_pool).

                /*******************************
                *             HOSTS            *
                *******************************/

:- begin_tests(cell_keys).

test(owners_policies_and_hosts_have_cells_of_their_own, Count == 5) :-
    findall(Key,
            ( member(Kind-H-P-O, [ owner-h-p-a, owner-h-p-b, owner-h-q-a,
                                   owner-g-p-a, host-h-p-a, host-h-p-b ]),
              typhon_gatekeeper:key(Kind, P, agent(i, H, m, x, l), O, Key) ),
            Keys),
    sort(Keys, Set),
    length(Set, Count).
test(hosts_that_can_have_no_cells,
     Errors == [ permission_error(limit, cell, inferences(7)),
                 permission_error(start, cell, clock(virtual)),none,none ]) :-
    findall(E, ( member(Os, [ [quota([seconds(1),inferences(7)])],
                              [clock(virtual)], [quota([seconds(1)])],
                              [clock(real)] ]),
                 ( typhon_cell_hosts:excluded(Os, error(E0, _), _) -> E = E0
                 ; E = none ) ), Errors).
test(frames_are_of_the_turn, Of == [yes,yes,no,no,no]) :-
    findall(O, ( member(F, [ end_of_file, told(3, []), told(4, []), told(_, []),
                             told ]),
                 ( typhon_gatekeeper:is_of_turn(F, 3) -> O = yes ; O = no ) ),
            Of).
test(end_of_a_cell_has_its_reason,
     Results == [ broken(ended(something)), broken(violation(x)),
                  broken(violation(syntax_error(x))),
                  broken(violation(too_deep)), error ]) :-
    findall(R, ( member(F, [ io_error(a, b), cell_violation(x), syntax_error(x),
                             resource_error(c_stack), other ]),
                 catch(typhon_gatekeeper:broken(F, _, R), error(other, _),
                       R = error) ), Results).

:- end_tests(cell_keys).
