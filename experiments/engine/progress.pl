:- module(study_progress,
          [ progress/4,                 % +Stream, +Done, +Total, +Note
            progress_done/1             % +Stream
          ]).

/** <module> A progress bar

On a terminal one line that is updated; elsewhere (a file, a pipe, a build
server) one plain line for each tenth of the work.

*Threading*: one thread draws on one stream.
*/

:- dynamic
    shown/2.                    % Stream, Tenth or line last shown

%!  progress(+Stream, +Done, +Total, +Note) is det.
%
%   Shows that Done of Total items are done.  Note is text that follows the
%   numbers.

progress(Stream, Done, Total, Note) :-
    Tenth is 10*Done // max(1, Total),
    (   stream_property(Stream, tty(true))
    ->  bar(Done, Total, Bar),
        format(atom(Line), '~a ~d/~d ~w', [Bar, Done, Total, Note]),
        changed(Stream, Line),
        format(Stream, '\r\e[K~a', [Line])
    ;   changed(Stream, Tenth),
        format(Stream, '~d/~d ~w~n', [Done, Total, Note])
    ),
    !,
    flush_output(Stream).
progress(_, _, _, _).           % nothing new to show

changed(Stream, State) :-
    \+ shown(Stream, State),
    retractall(shown(Stream, _)),
    assertz(shown(Stream, State)).

bar(Done, Total, Bar) :-
    Full is 30*Done // max(1, Total),
    Edge is Full + 1,
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
