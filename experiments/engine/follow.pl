:- module(study_follow,
          [ new_lines/4                 % +File, +Position0, -Position, -Lines
          ]).
:- use_module(library(lists), [append/3]).
:- use_module(library(readutil), [read_stream_to_codes/2]).

/** <module> Reading a growing file

*Threading*: no state; any thread.
*/

%!  new_lines(+File, +Position0, -Position, -Lines:list(string)) is det.
%
%   Lines are the complete lines of File after byte Position0.  Position is the
%   start of the next line.  Begin with Position0 = 0.  A file that does not
%   exist yet has no lines.

new_lines(File, Position0, Position, Lines) :-
    exists_file(File),
    !,
    setup_call_cleanup(
        open(File, read, In, [type(binary)]),
        ( seek(In, Position0, bof, _),
          read_stream_to_codes(In, Codes)
        ),
        close(In)),
    complete_lines(Codes, Position0, Position, Lines).
new_lines(_, Position, Position, []).

complete_lines(Codes, Position0, Position, [Line|Lines]) :-
    append(LineCodes, [0'\n|Rest], Codes),
    !,
    string_codes(Line, LineCodes),
    length(LineCodes, Length),
    Position1 is Position0 + Length + 1,
    complete_lines(Rest, Position1, Position, Lines).
complete_lines(_, Position, Position, []).
