:- module(typhon_watch,
          [ watch_frame/4               % +Way, +Session, +Term, +Bytes
          ]).

/** <module> One can see the frames

With the debug topic typhon(frame) each frame is told where it is sent and
where it is taken: the key of the session, what it is, the number of the
request, and its length.

*Threading*: no state.
*/

:- use_module(library(debug), [debug/3, debugging/1]).
:- use_module(session, [session_key/2]).

%!  watch_frame(+Way, +Session, +Term, +Bytes) is det.
%
%   Way is `to` or `from` the peer. Costs next to nothing if nobody looks.

watch_frame(Way, Session, Term, Bytes) :-
    (   debugging(typhon(frame))
    ->  session_key(Session, Key),
        frame_words(Term, Words),
        string_length(Bytes, Length),
        debug(typhon(frame), '~w ~w: ~w, ~D bytes',
              [Way, Key, Words, Length])
    ;   true
    ).

frame_words(post(Kind, _), post(Kind)) :-
    !.
frame_words(request(Id, Kind, _), request(Id, Kind)) :-
    !.
frame_words(answer(Id, _), answer(Id)) :-
    !.
frame_words(ack(Count, Bytes), ack(Count, Bytes)) :-
    !.
frame_words(spoilt(Id), spoilt(Id)) :-
    !.
frame_words(unreadable(_, Mark), unreadable(Mark)) :-
    !.
frame_words(Term, Kind) :-
    functor(Term, Kind, _).
