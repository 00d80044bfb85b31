:- module(typhon_private,
          [ private_folder/2,           % +Prefix, -Folder
            private_new/2,              % +File, +Text
            private_write/2,            % +File, :Writer
            private_open/4,             % +File, +Mode, -Stream, +Options
            output_file/2               % +Kind, +File
          ]).

/** <module> Folders and files of this user alone

A folder is made under a new name, with mode 700, and is never one that exists:
in a directory for all users another one may have made that, or a link.  A file
has mode 600.  open/4 follows the umask, so a new file is made in such a folder
beside its place.

A file that a command reads, or that holds another thing than the output, is kept:
arguments the wrong way round destroy nothing.

*Threading*: any thread.
*/

:- use_module(library(error), [permission_error/3]).
:- autoload(library(filesex),
            [ chmod/2, delete_directory_and_contents/1, directory_file_path/3,
              link_file/3 ]).

:- meta_predicate
    private_write(+, 1),
    beside(+, 1, 1).

:- multifile
    begins/2.                           % Kind, Text: files of Kind begin with Text

%!  private_folder(+Prefix, -Folder:atom) is det.
%
%   Make a folder; its path is Prefix, a dot, and text that cannot be guessed.
%
%   @error permission_error(create, directory, Folder)

private_folder(Prefix, Folder) :-
    Mark is random(1<<62),
    format(atom(Folder), '~w.~36r', [Prefix, Mark]),
    make_directory(Folder),
    chmod(Folder, 0o700),
    (   directory_files(Folder, Files),
        sort(Files, ['.', '..'])        % made before the mode was set
    ->  true
    ;   throw(error(permission_error(create, directory, Folder), _))
    ).

%!  private_new(+File, +Text) is det.
%
%   Make File, complete and private, or leave that which is there: of several
%   processes that try at once the first succeeds.

private_new(File, Text) :-
    beside(File, written(Text), linked(File)).

linked(File, New) :-
    catch(link_file(New, File, hard), error(_, _), true),
    (   access_file(File, exist)
    ->  true
    ;   rename_file(New, File)          % a file system without hard links
    ).

%!  private_write(+File, :Writer) is det.
%
%   Replace File, or make it, when call(Writer, Path) has written Path.  If that
%   raises an error File stays as it was.

private_write(File, Writer) :-
    beside(File, Writer, replaced(File)).

replaced(File, New) :-
    rename_file(New, File).

beside(File, Writer, Move) :-
    setup_call_cleanup(
        catch(private_folder(File, Folder), error(Formal, Context),
              told_of(File, error(Formal, Context))),
        ( directory_file_path(Folder, new, New),
          call(Writer, New),
          chmod(New, 0o600),
          call(Move, New) ),
        delete_directory_and_contents(Folder)).

%   The error is that of open/4 for File.

told_of(File, error(Formal0, Context)) :-
    (   Formal0 = permission_error(_, _, _)
    ->  Formal = permission_error(open, source_sink, File)
    ;   Formal0 = existence_error(_, _)
    ->  Formal = existence_error(source_sink, File)
    ;   Formal = Formal0
    ),
    throw(error(Formal, Context)).

written(Text, New) :-
    setup_call_cleanup(
        open(New, write, Out, [encoding(utf8)]),
        write(Out, Text),
        close(Out)).

%!  private_open(+File, +Mode, -Stream, +Options) is det.
%
%   As open/4, for writing.  A file that exists becomes private; that fails if
%   it belongs to another user.
%
%   @error as open/4

private_open(File, Mode, Stream, Options) :-
    (   access_file(File, exist)
    ->  true
    ;   read_link(File, _, _)           % open/4 makes the file it leads to
    ->  true
    ;   private_new(File, '')
    ),
    open(File, Mode, Stream, Options),
    (   exists_file(File)               % no device, and no pipe
    ->  catch(chmod(File, 0o600), error(Formal, Context),
              ( close(Stream), throw(error(Formal, Context)) ))
    ;   true
    ).

                /*******************************
                *       FILES OF OUTPUT        *
                *******************************/

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
