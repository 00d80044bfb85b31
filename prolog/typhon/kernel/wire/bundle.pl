:- module(typhon_bundle,
          [ bundle_fits/1,              % +Bytes
            bundle_next/5,              % +Queue, +Codec, +Room, -Bytes, -Many
            bundle_all/3,               % +Queue, +Codec, -Frames
            bundle_parts/2              % +Bundle, -Parts
          ]).

/** <module> Small frames that wait together go in one

To write a frame, to read and check it and to keep it until it is
acknowledged costs more than what is in a small one.  So posts that wait are
loose(Bytes), and as many as there are, up to a hundred, become one frame,
bundle(Parts).

*Threading*: the mutex of the session guards the queue, from which nobody
else takes.
*/

:- use_module(library(lists), [member/2]).
:- use_module(frame, [term_bytes/3]).

%   A bundle is no more than can be under way, see outbox.pl.

longest_part(512).
most_parts(100).
part_overhead(16).

%!  bundle_fits(+Bytes) is semidet.
%
%   Bytes may be part of a bundle.

bundle_fits(Bytes) :-
    string_length(Bytes, Length),
    longest_part(Most),
    Length =< Most.

%!  bundle_next(+Queue, +Codec, +Room, -Bytes, -Many) is semidet.
%
%   Take the next frame of Queue: fails where there is none, or not one of
%   Room bytes, a number or `inf`.  Many is `true` if it is a bundle.

bundle_next(Queue, Codec, Room, Bytes, Many) :-
    thread_peek_message(Queue, Next),
    first_length(Next, Length),
    Length =< Room,
    !,
    next(Next, Queue, Codec, Room, Bytes, Many).

first_length(loose(Bytes), Length) :-
    !,
    string_length(Bytes, Length).
first_length(Bytes, Length) :-
    string_length(Bytes, Length).

next(loose(_), Queue, Codec, Room, Bytes, Many) :-
    !,
    most_parts(Most),
    parts(Most, Room, Queue, Parts),
    bundled(Parts, Codec, Bytes, Many).
next(Bytes, Queue, _, _, Bytes, false) :-
    thread_get_message(Queue, _).

bundled([Bytes], _, Bytes, false) :-
    !.
bundled(Parts, Codec, Bytes, true) :-
    term_bytes(Codec, bundle(Parts), Bytes).

parts(Most, Room0, Queue, Parts) :-
    (   Most > 0,
        thread_peek_message(Queue, Next),
        Next = loose(Part),
        string_length(Part, Length),
        Length =< Room0
    ->  thread_get_message(Queue, _),
        Parts = [Part|More],
        room_left(Room0, Length, Room),
        Most1 is Most-1,
        parts(Most1, Room, Queue, More)
    ;   Parts = []
    ).

room_left(inf, _, inf) :-
    !.
room_left(Room0, Length, Room) :-
    part_overhead(Overhead),
    Room is Room0-Length-Overhead.

%!  bundle_all(+Queue, +Codec, -Frames:list) is det.
%
%   Take all that waits.

bundle_all(Queue, Codec, Frames) :-
    (   bundle_next(Queue, Codec, inf, Bytes, _)
    ->  Frames = [Bytes|More],
        bundle_all(Queue, Codec, More)
    ;   Frames = []
    ).

%!  bundle_parts(+Bundle, -Parts:list) is semidet.
%
%   Fails for what is not a bundle, be it that a peer calls it so.

bundle_parts(bundle(Parts), Parts) :-
    is_list(Parts),
    \+ ( member(Part, Parts),
         \+ string(Part) ).
