:- module(typhon_counts,
          [ ack_frames/1,               % -Count
            counts_open/1,              % +Key
            counts_forget/1,            % +Key
            received/2,                 % +Key, -Count
            note_received/2,            % +Key, +Count
            acknowledged/3,             % +Key, -Count, -Bytes
            note_acknowledged/3         % +Key, +Count, +Bytes
          ]).

/** <module> The counts of a session

Frames are numbered by counting on both sides. Two counts are kept of each
session, by its key: how many frames of the peer's have been handled, and
how many of ours it has said to have.

*Threading*: what was received is for the thread of the connection alone,
what is acknowledged is guarded by the mutex of the session.
*/

:- dynamic
    received/2,                         % Key, Count
    acknowledged/3.                     % Key, Count, Bytes

%!  ack_frames(-Count) is det.
%
%   After so many frames the peer is told that they have come.

ack_frames(32).

%!  counts_open(+Key) is det.
%!  counts_forget(+Key) is det.
%
%   There is a session Key; there is none any more.

counts_open(Key) :-
    assertz(received(Key, 0)).

counts_forget(Key) :-
    retractall(received(Key, _)),
    retractall(acknowledged(Key, _, _)).

%!  received(+Key, -Count) is semidet.
%!  note_received(+Key, +Count) is det.
%
%   How many frames had been received when the last connection ended.

note_received(Key, Count) :-
    retractall(received(Key, _)),
    assertz(received(Key, Count)).

%!  acknowledged(+Key, -Count, -Bytes) is semidet.
%!  note_acknowledged(+Key, +Count, +Bytes) is det.
%
%   The peer has Count frames of the session, and Bytes bytes of its
%   connection. Fails if it never had a connection.

note_acknowledged(Key, Count, Bytes) :-
    retractall(acknowledged(Key, _, _)),
    assertz(acknowledged(Key, Count, Bytes)).
