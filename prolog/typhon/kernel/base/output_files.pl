:- module(typhon_output_files,
          [ output_file/2               % +Kind, +File
          ]).
:- use_module(library(error), [permission_error/3]).

/** <module> Files that an output may replace or extend

A file that a command reads, or that holds another thing than the output, is kept:
arguments the wrong way round destroy nothing.

*Threading*: any thread.
*/

:- multifile
    begins/2.                   % Kind, Text: files of Kind begin with Text

begins(log, "event(").
begins(page, "<!doctype html>").
begins(picture, "<svg").
begins(saved_network, "typhon_saved(").
begins(restore_point, "restore_point(").

%!  output_file(+Kind, +File) is det.
%
%   An output of Kind may be written to File: there is no such file, or it is
%   empty, or begins as an output of that Kind.  Devices and pipes may be written.
%
%   @error permission_error(overwrite, Kind, File)

output_file(Kind, File) :-
    exists_file(File),
    \+ size_file(File, 0),
    begins(Kind, Text),
    \+ starts_with(File, Text),
    !,
    permission_error(overwrite, Kind, File).
output_file(_, _).

starts_with(File, Text) :-
    string_length(Text, Length),
    access_file(File, read),
    setup_call_cleanup(
        open(File, read, In, [type(binary)]),
        read_string(In, Length, Text),
        close(In)).
