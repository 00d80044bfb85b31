:- module(typhon_nxt_files,
          [ nxt_files/3,                % +Brick, +Pattern, -Files
            nxt_file_exists/2,          % +Brick, +File
            nxt_file_read/3,            % +Brick, +File, -Bytes
            nxt_file_write/3,           % +Brick, +File, +Bytes
            nxt_file_delete/2,          % +Brick, +File
            nxt_upload/3,               % +Brick, +Local, +File
            nxt_download/3,             % +Brick, +File, +Local
            nxt_program_start/2,        % +Brick, +File
            nxt_program_stop/1,         % +Brick
            nxt_program/2               % +Brick, -File
          ]).
:- autoload(library(crypto), [hex_bytes/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [append/3]).
:- use_module(library(readutil), [read_file_to_codes/3]).
:- use_module(brick, [nxt_command/4]).
:- use_module(link, [nxt_text/2]).

/** <module> Files and programs of a brick

Names have up to 15 characters, a dot and up to 3 more.  Files are transferred
in pieces, each by a call with its own deadline, so that other callers can use
the brick meanwhile.

*Threading*: any thread; see typhon_nxt_link.
*/

piece_bytes(56).                % a telegram has at most 64

%!  nxt_files(+Brick, +Pattern, -Files:list) is det.
%
%   Files are Name-Size.  Pattern is '*.*', 'name.*', '*.ext' or a name.

nxt_files(Brick, Pattern, Files) :-
    nxt_text(19, Pattern),
    (   found('FINDFIRST', Brick, _{pattern:Pattern}, First)
    ->  with_handle(Brick, First.handle,
                    more_files(Brick, First, Files))
    ;   Files = []
    ).

found(Command, Brick, Args, File) :-
    catch(nxt_command(Brick, Command, Args, File),
          error(nxt_error(refused(file_not_found), _), _),
          fail).

more_files(Brick, File, [Name-Size|Files]) :-
    Name = File.name,
    Size = File.size,
    (   found('FINDNEXT', Brick, _{handle:File.handle}, Next)
    ->  more_files(Brick, Next, Files)
    ;   Files = []
    ).

%   setup_call_cleanup/3 cannot be used: Prolog observes no deadline in a
%   cleanup handler.

:- meta_predicate with_handle(+, +, 0).

with_handle(Brick, Handle, Goal) :-
    catch(Goal, Ball, true),
    !,
    (   nonvar(Ball)
    ->  catch(close_handle(Brick, Handle), error(_, _), true),
        throw(Ball)
    ;   close_handle(Brick, Handle)
    ).

close_handle(Brick, Handle) :-
    nxt_command(Brick, 'CLOSE', _{handle:Handle}, _).

%!  nxt_file_exists(+Brick, +File) is semidet.
%
%   Brick has a file with that name.

nxt_file_exists(Brick, File) :-
    nxt_files(Brick, File, [_|_]).

%!  nxt_file_read(+Brick, +File, -Bytes:list) is det.
%
%   Bytes are the content of File on the brick.
%
%   @error nxt_error(refused(file_not_found), Brick)

nxt_file_read(Brick, File, Bytes) :-
    nxt_text(19, File),
    nxt_command(Brick, 'OPENREAD', _{name:File}, Open),
    with_handle(Brick, Open.handle,
                read_pieces(Brick, Open.handle, Open.size, Bytes)).

read_pieces(_, _, 0, Bytes) :-
    !,
    Bytes = [].
read_pieces(Brick, Handle, Left, Bytes) :-
    piece_bytes(Piece),
    Size is min(Piece, Left),
    nxt_command(Brick, 'READ', _{handle:Handle, size:Size}, Reply),
    hex_bytes(Reply.data, Read),
    append(Read, More, Bytes),
    Left1 is Left-Size,
    read_pieces(Brick, Handle, Left1, More).

%!  nxt_file_write(+Brick, +File, +Bytes:list) is det.
%
%   Write a file; replaces a file with that name.
%
%   @error nxt_error(refused(Status), Brick), with a Status such as no_space

nxt_file_write(Brick, File, Bytes) :-
    nxt_text(19, File),
    must_be(list(between(0, 255)), Bytes),
    length(Bytes, Size),
    (   nxt_file_exists(Brick, File)
    ->  nxt_file_delete(Brick, File)
    ;   true
    ),
    nxt_command(Brick, 'OPENWRITE', _{name:File, size:Size}, Open),
    with_handle(Brick, Open.handle,
                write_pieces(Bytes, Size, Brick, Open.handle)).

write_pieces([], 0, _, _) :-
    !.
write_pieces(Bytes, Left, Brick, Handle) :-
    piece_bytes(Piece),
    Size is min(Piece, Left),
    length(Part, Size),
    append(Part, Rest, Bytes),
    hex_bytes(Hex, Part),
    nxt_command(Brick, 'WRITE', _{handle:Handle, data:Hex}, _),
    Left1 is Left-Size,
    write_pieces(Rest, Left1, Brick, Handle).

%!  nxt_file_delete(+Brick, +File) is det.
%
%   Delete File on the brick.
%
%   @error nxt_error(refused(file_not_found), Brick)

nxt_file_delete(Brick, File) :-
    nxt_text(19, File),
    nxt_command(Brick, 'DELETE', _{name:File}, _).

%!  nxt_upload(+Brick, +Local, +File) is det.
%!  nxt_download(+Brick, +File, +Local) is det.
%
%   Copy a file of this machine to File on the brick, and back.

nxt_upload(Brick, Local, File) :-
    read_file_to_codes(Local, Bytes, [type(binary)]),
    nxt_file_write(Brick, File, Bytes).

nxt_download(Brick, File, Local) :-
    nxt_file_read(Brick, File, Bytes),
    setup_call_cleanup(
        open(Local, write, Out, [type(binary)]),
        format(Out, '~s', [Bytes]),
        close(Out)).

%!  nxt_program_start(+Brick, +File) is det.
%
%   Start a program, such as 'demo.rxe'.
%
%   @error nxt_error(refused(Status), Brick), Status out_of_range or
%          request_failed if there is no such program

nxt_program_start(Brick, File) :-
    nxt_text(19, File),
    nxt_command(Brick, 'STARTPROGRAM', _{name:File}, _).

%!  nxt_program_stop(+Brick) is det.
%
%   Stop the running program.
%
%   @error nxt_error(refused(no_active_program), Brick)

nxt_program_stop(Brick) :-
    nxt_command(Brick, 'STOPPROGRAM', _{}, _).

%!  nxt_program(+Brick, -File) is semidet.
%
%   File is the running program.  Fails if none is running.

nxt_program(Brick, File) :-
    catch(nxt_command(Brick, 'GETCURRENTPROGRAMNAME', _{}, Values),
          error(nxt_error(refused(no_active_program), _), _),
          fail),
    File = Values.name.
