:- module(typhon_output,
          [ output_own/0,
            output_rest/0,
            output_forward/1            % :Show
          ]).
:- use_module(library(lists), [append/3, last/2, member/2]).
:- use_module(library(prolog_stream), [open_prolog_stream/4]).

/** <module> What threads print while somebody types

Who sits at a terminal types at its last line, and other threads print: agents,
and rooms that have something to tell. What these print is shown in whole
lines, above the line on which the cursor stands, and that line stays as it
is. For this the threads of the platform have another current output, and
their messages go there, too: one stream, which is never closed, for threads
hand their output down to those that they create. What it is given is put
together to lines in the thread that writes.

A process that has no terminal can forward lines to one that has. Where there
is neither, nothing is done: output is plain user output.

*Threading*: any thread. Lines are shown one at a time.
*/

:- meta_predicate
    output_forward(2).

:- multifile
    output_mark/1,              % Mark: who prints in this thread
    user:message_property/2.

:- dynamic
    output_mark/1,
    user:message_property/2,
    forward/1,                  % Show
    shared/1.                   % Stream, or `none`

%!  output_forward(:Show) is det.
%
%   From now on lines of threads that have not begun are shown by
%   call(Show, Mark, Line), Mark being who prints, or `none`.

output_forward(Show) :-
    retractall(forward(_)),
    retractall(shared(_)),
    assertz(forward(Show)).

%!  output_own is det.
%
%   What this thread prints from now on, and the threads that it creates, is
%   shown line by line.

%
%   Where nothing is shown so, the output that the thread has been handed down
%   is not touched: it may be gone, as that of a test of which plunit of 10
%   captures what it prints, and then Prolog ends.

output_own :-
    shared_stream(Stream),
    (   Stream == none
    ->  true
    ;   set_output(Stream)
    ).

shared_stream(Stream) :-
    shared(Stream),
    !.
shared_stream(Stream) :-
    with_mutex(typhon_output, make_shared(Stream)).

make_shared(Stream) :-
    shared(Stream),
    !.
make_shared(Stream) :-
    (   colours(Colours),
        catch(lines_stream(Colours, Stream0), error(_, _), fail)
    ->  Stream = Stream0
    ;   Stream = none
    ),
    assertz(shared(Stream)).

colours(false) :-
    forward(_),
    !.
colours(true) :-
    terminal.

%   Unbuffered, it gets in one piece what one goal writes.

lines_stream(Colours, Stream) :-
    open_prolog_stream(typhon_output, write, Stream, []),
    set_stream(Stream, alias(typhon_output)),
    set_stream(Stream, buffer(false)),
    set_stream(Stream, tty(Colours)).

%   Messages of threads whose output is shown so, unless they go elsewhere.

user:message_property(Kind, stream(Stream)) :-
    Kind \== query,
    current_output(Stream),
    typhon_output:shared(Stream),
    stream_property(user_error, tty(true)).

                /*******************************
                *             LINES            *
                *******************************/

:- public
    stream_write/2,             % called by the stream
    stream_close/1.

stream_close(_).

stream_write(_, Text) :-
    (   nb_current(typhon_line, Begun)
    ->  string_concat(Begun, Text, Whole)
    ;   Whole = Text
    ),
    split_string(Whole, "\n", "", Lines),
    show_lines(Lines, "", Rest),
    (   Rest == ""
    ->  nb_delete(typhon_line)
    ;   nb_setval(typhon_line, Rest)
    ).

%   The colour in which a line ends is that of the next.

show_lines([Line], Colour, Rest) :-
    !,
    string_concat(Colour, Line, Rest).
show_lines([Line|Lines], Colour0, Rest) :-
    string_concat(Colour0, Line, Whole),
    show(Whole),
    last_colour(Whole, Colour),
    show_lines(Lines, Colour, Rest).

last_colour(Line, Colour) :-
    split_string(Line, "\e", "", [_,Part|Parts]),
    last([Part|Parts], Last),
    sub_string(Last, Before, 1, _, "m"),
    sub_string(Last, 0, Before, _, Sequence),
    Sequence \== "[0",
    !,
    string_concat("\e", Sequence, Colour0),
    string_concat(Colour0, "m", Colour).
last_colour(_, "").

%!  output_rest is det.
%
%   A line that this thread has begun is shown as it is.

output_rest :-
    (   nb_current(typhon_line, Line)
    ->  nb_delete(typhon_line),
        show(Line)
    ;   true
    ).

show(Line) :-
    string_codes(Line, Codes),
    colours_only(Codes),
    !.
show(Line) :-
    (   output_mark(Mark0)
    ->  Mark = Mark0
    ;   Mark = none
    ),
    with_mutex(typhon_output_line, show(Mark, Line)).

show(Mark, Line) :-
    forward(Show),
    !,
    call(Show, Mark, Line).
show(_, Line) :-
    above_cursor(Line).

                /*******************************
                *           TERMINAL           *
                *******************************/

%   terminal is semidet: somebody sits at one that can insert lines.

terminal :-
    stream_property(user_input, tty(true)),
    stream_property(user_output, tty(true)),
    \+ current_prolog_flag(emacs_inferior_process, true),
    getenv('TERM', Term),
    \+ memberchk(Term, [dumb, emacs, unknown]),
    catch(setup_call_cleanup(terminal_open(Stream), true, close(Stream)),
          error(_, _), fail).

terminal_open(Stream) :-
    open('/dev/tty', append, Stream, [encoding(utf8), buffer(full)]).

%   The terminal makes room below, if the cursor is in the last line, then
%   above, where Line is written; column and attributes are as before. The
%   line editor, which keeps account of what is written to the streams of the
%   user, is not asked.

above_cursor(Line) :-
    flush_output(user_output),
    width(Width),
    string_codes(Line, Codes),
    rows(Codes, Width, Rows),
    setup_call_cleanup(
        terminal_open(Out),
        forall(member(Row, Rows),
               format(Out, '\eD\e[A\e7\r\e[L~s\e8\e[B', [Row])),
        close(Out)).

width(Width) :-
    catch(tty_size(_, Width), error(_, _), fail),
    Width > 0,
    !.
width(80).

%   rows(+Codes, +Width, -Rows): what fits into the width, escape sequences
%   not counted.

rows(Codes, Width, [Row|Rows]) :-
    row(Codes, Width, Row, Rest),
    (   Rest == []
    ->  Rows = []
    ;   rows(Rest, Width, Rows)
    ).

row([], _, [], []) :-
    !.
row(Codes, Left, Row, Rest) :-
    sequence(Codes, Sequence, Codes1),
    !,
    append(Sequence, Row1, Row),
    row(Codes1, Left, Row1, Rest).
row(Codes, Left, Row, Rest) :-
    Left =< 0,
    !,
    Row = [],
    Rest = Codes.
row([Code|Codes], Left, [Code|Row], Rest) :-
    (   Code == 0'\t
    ->  Left1 is Left-8
    ;   Left1 is Left-1
    ),
    row(Codes, Left1, Row, Rest).

%   sequence(+Codes, -Sequence, -Rest): Codes begin with an escape sequence.

sequence([0'\e|Codes], [0'\e|Sequence], Rest) :-
    append(Begin, [Last|Rest], Codes),
    code_type(Last, csymf),
    !,
    append(Begin, [Last], Sequence).

colours_only(Codes) :-
    sequence(Codes, _, Rest),
    (   Rest == []
    ->  true
    ;   colours_only(Rest)
    ).
