:- module(typhon_output_files,
          [ not_a_log/1                 % +File
          ]).
:- use_module(library(error), [permission_error/3]).

/** <module> Files that may be replaced

*Threading*: any thread.
*/

%!  not_a_log(+File) is det.
%
%   File may be replaced by an output other than a log: it does not exist, or
%   does not begin with an event.
%
%   @error permission_error(overwrite, log, File)

not_a_log(File) :-
    exists_file(File),
    access_file(File, read),
    setup_call_cleanup(
        open(File, read, In, [type(binary)]),
        peek_string(In, 6, Start),
        close(In)),
    Start == "event(",
    !,
    permission_error(overwrite, log, File).
not_a_log(_).
