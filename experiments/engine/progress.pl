:- module(study_progress,
          [ progress/3,                 % +Stream, +Share, +Text
            progress_done/1             % +Stream
          ]).

/** <module> A progress bar

On a terminal one line that is updated; elsewhere (a file, a pipe, a build
server) one plain line for each tenth of the work.

*Threading*: one thread draws on one stream.
*/

:- dynamic
    shown/2.                    % Stream, Tenth or line last shown

%!  progress(+Stream, +Share, +Text) is det.
%
%   Shows that Share of the work, from 0 to 1, is done, and Text.

progress(Stream, Share, Text) :-
    (   stream_property(Stream, tty(true))
    ->  bar(Share, Bar),
        format(atom(Line), '~a ~w', [Bar, Text]),
        changed(Stream, Line),
        format(Stream, '\r\e[K~a', [Line])
    ;   Tenth is truncate(10*Share),
        changed(Stream, Tenth),
        format(Stream, '~w~n', [Text])
    ),
    !,
    flush_output(Stream).
progress(_, _, _).              % nothing new to show

changed(Stream, State) :-
    \+ shown(Stream, State),
    retractall(shown(Stream, _)),
    assertz(shown(Stream, State)).

bar(Share, Bar) :-
    Edge is truncate(30*Share) + 1,
    format(atom(Bar), '[~`=t~*|~` t~31|]', [Edge]).

%!  progress_done(+Stream) is det.
%
%   Ends the line of the bar.

progress_done(Stream) :-
    (   retract(shown(Stream, _)),
        stream_property(Stream, tty(true))
    ->  nl(Stream)
    ;   true
    ).
