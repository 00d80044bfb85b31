:- module(lasting_power,
          [ power_copy/1,               % +Dir
            power_cut/1                 % +Dir
          ]).

/** <module> The power fails while a journal is written

After a power failure each sector of a file that was written since its last
sync holds the old or the new data, or, if the sector is new, anything. The
length of the file is uncertain, too.

SQLite syncs twice within a commit: the head of its log, where it begins that
anew, before anything follows it there, and the log before anything of it goes
to the database.  Later writes have not happened if the writes before such a
sync are missing.

*Threading*: any thread.
*/

:- use_module(library(filesex),
              [ copy_file/2, delete_directory_and_contents/1,
                directory_file_path/3, make_directory_path/1 ]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

sector(512).

file('journal.db').
file('journal.db-wal').

copies(Dir, Copies) :-
    atom_concat(Dir, '.synced', Copies).

%!  power_copy(+Dir) is det.
%
%   The files of the journal Dir are synced: keep a copy.

power_copy(Dir) :-
    copies(Dir, Copies),
    make_directory_path(Copies),
    forall(( file(Name), directory_file_path(Dir, Name, File),
             exists_file(File) ),
           ( directory_file_path(Copies, Name, Copy),
             copy_file(File, Copy) )),
    directory_file_path(Copies, whole, Whole),
    setup_call_cleanup(open(Whole, write, Out), true, close(Out)).

%!  power_cut(+Dir) is semidet.
%
%   Change the files in Dir, whose process is dead, to a state that a power
%   failure could have left. Fails if there was none.

power_cut(Dir) :-
    copies(Dir, Copies),
    directory_file_path(Copies, whole, Whole),
    (   exists_file(Whole)
    ->  both(Copies, Dir, 'journal.db', Db0, Db),
        both(Copies, Dir, 'journal.db-wal', Log0, Log),
        what_is_left(Db0-Db, Log0-Log, Dir),
        delete_directory_and_contents(Copies)
    ;   exists_directory(Copies),       % the process died while it copied
        delete_directory_and_contents(Copies),
        fail
    ).

%   both(+Copies, +Dir, +Name, -Synced, -Written)

both(Copies, Dir, Name, Synced, Written) :-
    contents(Copies, Name, Synced),
    contents(Dir, Name, Written).

contents(Dir, Name, Bytes) :-
    directory_file_path(Dir, Name, File),
    (   exists_file(File)
    ->  read_file_to_string(File, Bytes, [encoding(octet)])
    ;   Bytes = ""
    ).

what_is_left(Db-Db, Log0-Log, Dir) :-
    !,
    begun(Log0, Log, Log1),
    directory_file_path(Dir, 'journal.db-wal', File),
    (   Log1 == Log0,
        random_member(true, [true, false, false])
    ->  mix(Log0, Log0, File)
    ;   mix(Log1, Log, File)
    ).
what_is_left(Db0-Db, _, Dir) :-
    directory_file_path(Dir, 'journal.db', File),
    mix(Db0, Db, File).

%   begun(+Log0, +Log, -Log1): Log1 is the log with the head of Log, if that is
%   another one.

head_bytes(32).

begun(Log0, Log, Log1) :-
    head_bytes(Bytes),
    (   sub_string(Log, 0, Bytes, _, Head),
        sub_string(Log0, 0, Bytes, _, Head0),
        Head \== Head0
    ->  sub_string(Log0, Bytes, _, 0, Rest),
        string_concat(Head, Rest, Log1)
    ;   Log1 = Log0
    ).

mix(Synced, Written, File) :-
    string_length(Synced, Least),
    string_length(Written, Length),
    random_member(Share, [0.0, 0.5, 0.9, 1.0]),  % share of writes on disk
    most(Least, Length, Most),
    sector(Sector),
    setup_call_cleanup(
        open(File, write, Out, [encoding(octet)]),
        forall(between_by(0, Most, Sector, Start),
               ( Size is min(Sector, Most-Start),
                 put_sector(Start, Size, Synced-Least, Written-Length, Share,
                            Out) )),
        close(Out)).

%   A file that was truncated since may have its old length.

most(Least, Length, Most) :-
    (   Length > Least
    ->  random_between(Least, Length, Most)
    ;   Most = Least
    ).

between_by(From, To, Step, N) :-
    Count is (To-From+Step-1)//Step-1,
    between(0, Count, I),
    N is From+I*Step.

%   The other bytes of a sector are unchanged.

put_sector(Start, Size, Synced-Least, Written-Length, Share, Out) :-
    (   Start+Size =< Length,
        random_float < Share
    ->  put_bytes(Written, Start, Size, Out)
    ;   Old is max(0, min(Size, Least-Start)),
        New is Size-Old,
        put_bytes(Synced, Start, Old, Out),
        put_bytes(none, Start, New, Out)
    ).

put_bytes(none, _, Size, Out) :-
    !,
    random_member(Garbage, [true, false]),
    forall(between(1, Size, _),
           ( ( Garbage == true -> random_between(0, 255, Byte) ; Byte = 0 ),
             put_char_code(Out, Byte) )).
put_bytes(_, _, 0, _) :-
    !.
put_bytes(Bytes, Start, Size, Out) :-
    sub_string(Bytes, Start, Size, _, Part),
    write(Out, Part).

put_char_code(Out, Code) :-
    char_code(Char, Code),
    put_char(Out, Char).
