:- module(test_bundle, []).

/** <module> Many small posts: few frames, each post once and in order

*Threading*: the peer is another process.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/endpoints').
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [append/3, member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(thread), [concurrent_forall/3]).
:- use_module(library(typhon/kernel/wire)).
:- use_module(library(typhon/kernel/travel), []).
:- use_module('../../../lib/frame_proxy').

:- dynamic note/2.                      % Note, Thread

:- multifile typhon_endpoint:received/3, typhon_kinds:accepts/5.

typhon_kinds:accepts(post, note, _, none, none).

typhon_endpoint:received(note, Note, _) :-
    thread_self(Me),
    assertz(note(Note, Me)).

forget_notes :-
    retractall(note(_, _)).

has_note(Note) :-
    note(Note, _),
    !.

:- meta_predicate with_peer(-, 0).

with_peer(Address, Goal) :-
    with_endpoint(with_peer_process(
                      [setup(set_setting(typhon_reader:silence, 100))], _, _,
                      Address, once(Goal))).

post_notes(Address, From, To) :-
    forall(between(From, To, I), endpoint_post(Address, note, I)).

notes(Address, Notes) :-
    endpoint_call(Address, notes, x, answer(Notes), 20).

%   with_counted_peer(-Address, :Goal): the frames that go there are counted.

:- meta_predicate with_counted_peer(-, 0).

with_counted_peer(Address, Goal) :-
    with_peer(Peer,
              setup_call_cleanup(
                  ( frame_proxy_start(peer, Peer, Proxy, Address),
                    script([], true) ),
                  once(Goal),
                  frame_proxy_stop(Proxy))).

:- begin_tests(many_small_posts).

test(posts_are_bundled_in_few_frames, true(Frames < 1500)) :-
    numlist(1, 3000, Sent),
    with_counted_peer(A, ( post_notes(A, 1, 3000),
                           notes(A, Notes),
                           assertion(Notes == Sent),
                           endpoint_address(Me),
                           frames_passed(Me-peer, Frames),
                           assertion(Frames > 10) )).
test(as_text, true(Notes == Sent)) :-
    numlist(1, 500, Sent),
    with_settings([typhon_handshake:records=false],
                  with_peer(A, ( post_notes(A, 1, 500), notes(A, Notes) ))).
test(bundled_posts_keep_their_order_with_long_ones, true(Notes == Sent)) :-
    numlist(1, 40, Numbers),
    maplist(long_or_short, Numbers, Some),
    append(Some, Some, Twice),
    append(Twice, Twice, Sent),
    with_peer(A, ( forall(member(Note, Sent), endpoint_post(A, note, Note)),
                   notes(A, Notes) )).

%   The peer is not asked for a sign of life either.

test(last_post_is_sent_without_a_successor, true(Found == Sent)) :-
    numlist(1, 200, Sent),
    forget_notes,
    with_settings([typhon_reader:silence=100],
        with_peer(A, ( endpoint_post(A, back, 200),
                       wait_until(has_note(200), 20) ))),
    findall(Note, note(Note, _), Found).
test(posts_arrive_before_the_endpoint_stops, true(Flushed == true)) :-
    with_settings([typhon_reader:silence=100],
        with_peer(A, ( post_notes(A, 1, 500),
                       (   endpoint_flush(20)
                       ->  Flushed = true
                       ;   Flushed = false
                       ) ))).
test(posts_of_many_threads, true(Sorted == Sent)) :-
    numlist(1, 2000, Sent),
    with_peer(A, ( concurrent_forall(member(From, [1, 501, 1001, 1501]),
                                     ( To is From+499,
                                       post_notes(A, From, To) ),
                                     [threads(4)]),
                   notes(A, Notes),
                   msort(Notes, Sorted) )).
test(posts_to_itself_are_delivered_at_once, true(Found == [1-Me, 2-Me])) :-
    forget_notes,
    thread_self(Me),
    with_endpoint(( endpoint_address(Own),
                    post_notes(Own, 1, 2),
                    findall(Note-Thread, note(Note, Thread), Found) )).

long_or_short(I, Note) :-
    (   I mod 7 =:= 0
    ->  length(Note, 300),
        maplist(=(I), Note)
    ;   Note = I
    ).

:- end_tests(many_small_posts).

:- begin_tests(bundles).

test(unreadable_part_does_not_affect_others, true(Notes == [1, 2])) :-
    fast_term_serialized(post(note, 1), One),
    fast_term_serialized(post(note, 2), Two),
    with_peer(A, ( notes(A, []),
                   bundle_sent(A, bundle([One, "#-0 f((. ", Two])),
                   notes(A, Notes) )).
test(invalid_bundle,
     [ forall(member(Bundle, [bundle(x), bundle([x]), bundle(_)])),
       true(Notes == []) ]) :-
    with_peer(A, ( notes(A, []), bundle_sent(A, Bundle), notes(A, Notes) )).

%   There is no interface for frames that no process of ours sends.

bundle_sent(Address, Bundle) :-
    once(typhon_session:route(Address, Session)),
    typhon_session:session_send(Session, Bundle).

:- end_tests(bundles).

:- begin_tests(grouped_letters).

test(letters_are_grouped_by_agent,
     true(Fewer == [ message(a, [mail(x,u,1), mail(y,v,2)], 9),
                     message(b, [mail(x,u,3)], 5) ])) :-
    together([ message(a, [mail(x,u,1)], 7), message(b, [mail(x,u,3)], 5),
               message(a, [mail(y,v,2)], 9) ], Fewer).
test(unusual_letters_are_not_grouped,
     [ forall(member(Odd, [ lost(x, a, []), message(a, [], many), nonsense,
                            message(_, [], 1), message(a, [x|_], 1) ])),
       fail ]) :-
    together([message(a, [mail(x,u,1)], 7), Odd], _).

together(Letters, Fewer) :-
    typhon_endpoint:together(message, Letters, Fewer).

:- end_tests(grouped_letters).
