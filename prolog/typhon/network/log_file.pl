:- module(typhon_log_file,
          [ log_open/3,                 % +File, +Mode, -Stream
            log_write/2,                % +Stream, +Event
            log_read/2,                 % +Spec, -Events
            log_size/2,                 % +File, -Size
            log_goes_on/2               % +File, +Size
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module('../kernel/base/private', [output_file/2, private_open/4]).
:- autoload(library(readutil), [read_line_to_string/2]).

/** <module> The file of a log

One fact per line,

    event(Time, Host, Agent, What).

The file is plain ASCII for all characters of events, and uses no operators, so
consult/1 reads it on every system. log_read/2 reads it line by line, so a line
cut short by a crash costs only that line.

*Threading*: any thread; a stream belongs to one thread.
*/

:- multifile
    about_to_read/1,
    prolog:message//1.

%   about_to_read(+File) is a hook: write the pending events of this process
%   that belong to File; fail if it writes none there.

%!  log_open(+File, +Mode, -Stream) is det.
%
%   Open File to write events, new (`write`) or at its end (`append`).
%
%   @error existence_error(directory, Dir), permission_error(open,
%   source_sink, File), permission_error(overwrite, log, File)

log_open(File, Mode, Stream) :-
    may_write(File),
    output_file(log, File),
    catch(private_open(File, Mode, Stream,
                       [ encoding(ascii), newline(posix), buffer(full) ]),
          error(existence_error(_, _), _),
          not_writable(File)),
    (   Mode == append,
        cut_short(File)
    ->  nl(Stream)
    ;   true
    ).

%!  log_size(+File, -Size) is det.
%
%   Size is the size of File in bytes, including all events that have arrived.

log_size(File, Size) :-
    ignore(about_to_read(File)),
    size_file(File, Size).

%!  log_goes_on(+File, +Size) is det.
%
%   Truncate File to Size, or empty it if it is shorter.

log_goes_on(File, Size0) :-
    output_file(log, File),
    size_file(File, Now),
    (   Now >= Size0
    ->  Size = Size0
    ;   Size = 0
    ),
    setup_call_cleanup(
        open(File, update, Out, [type(binary)]),
        ( seek(Out, Size, bof, _),
          set_end_of_stream(Out) ),
        close(Out)).

%   The last line of File is incomplete: the process that wrote it was killed.

cut_short(File) :-
    size_file(File, Size),
    Size > 0,
    setup_call_cleanup(
        open(File, read, In, [type(binary)]),
        ( Last is Size - 1,
          seek(In, Last, bof, _),
          get_byte(In, Byte)
        ),
        close(In)),
    Byte =\= 0'\n.

may_write(File) :-
    access_file(File, write),
    \+ exists_directory(File),
    !.
may_write(File) :-
    file_directory_name(File, Dir),
    \+ exists_directory(Dir),
    !,
    existence_error(directory, Dir).
may_write(File) :-
    not_writable(File).

not_writable(File) :-
    Text = 'the log cannot be written there',
    throw(error(permission_error(open, source_sink, File),
                context(log_server_start/2, Text))).

%!  log_write(+Stream, +Event) is det.
%
%   Write Event as one line.

log_write(Stream, Event) :-
    write_canonical(Stream, Event),
    write(Stream, '.\n').

%!  log_read(+File, -Events:list) is det.
%
%   See log_events/2.  The last line of a file that this process writes may be
%   there in part: it is not an event yet.

log_read(Spec, Events) :-
    absolute_file_name(Spec, File, [access(read)]),
    (   about_to_read(File)
    ->  Last = being_written
    ;   Last = written
    ),
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_events(In, File, Last, Events),
        close(In)).

read_events(In, File, Last, Events) :-
    line_count(In, Number),
    read_line_to_string(In, Line),
    (   Line == end_of_file
    ->  Events = []
    ;   line_event(Line, Event)
    ->  Events = [Event|Rest],
        read_events(In, File, Last, Rest)
    ;   Last == being_written,
        peek_char(In, end_of_file)
    ->  Events = []
    ;   print_message(warning, typhon(log_line_skipped(File:Number, Line))),
        read_events(In, File, Last, Events)
    ).

line_event(Line, Event) :-
    catch(term_string(Event, Line, [module(typhon_log_file)]),
          error(syntax_error(_), _), fail),
    nonvar(Event),
    Event = event(_, _, _, _).

prolog:message(typhon(log_line_skipped(File:Number, Line))) -->
    { ( sub_string(Line, 0, 60, _, Start) -> true ; Start = Line ) },
    [ '~w:~d: not an event, or cut short: ~s'-[File, Number, Start] ].
