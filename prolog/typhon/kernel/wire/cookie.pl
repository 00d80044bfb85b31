:- module(typhon_cookie,
          [ cookie/1,                   % -Cookie
            random_hex/2                % +Count, -Hex
          ]).

/** <module> The cookie: a secret that all processes of a network share

*Threading*: any thread. The cookie is kept with the time stamp of its file
in one fact; two threads that read it at once store the same.
*/

:- autoload(library(filesex),
            [chmod/2, delete_directory_and_contents/1, link_file/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(sha), [hash_atom/2]).

:- dynamic known_cookie/3.      % File, Time, Cookie

%!  random_hex(+Count, -Hex:atom) is det.
%
%   Hex are Count random bytes, of a quality for secrets.

random_hex(Count, Hex) :-
    setup_call_cleanup(
        open('/dev/urandom', read, In, [type(binary), buffer(false)]),
        ( length(Bytes, Count),
          maplist(get_byte(In), Bytes) ),
        close(In)),
    hash_atom(Bytes, Hex).

%!  cookie(-Cookie:string) is det.
%
%   Cookie is the secret that all processes of a network share: the value of
%   the environment variable `TYPHON_COOKIE`, or the content of the file
%   `TYPHON_COOKIE_FILE`, by default `~/.typhon.cookie`. The file is made
%   with random content on first use.
%
%   @error permission_error(use, cookie_file, File) if others may read or write
%   it, or it has no cookie; the context says which

cookie(Cookie) :-
    getenv('TYPHON_COOKIE', Value),
    Value \== '',
    !,
    atom_string(Value, Cookie).
cookie(Cookie) :-
    cookie_file(File),
    (   exists_file(File)
    ->  true
    ;   make_cookie(File)
    ),
    time_file(File, Time),
    (   known_cookie(File, Time, Known)
    ->  Cookie = Known
    ;   read_cookie(File, Cookie),
        retractall(known_cookie(_, _, _)),
        assertz(known_cookie(File, Time, Cookie))
    ).

cookie_file(File) :-
    (   getenv('TYPHON_COOKIE_FILE', File0),
        File0 \== ''
    ->  true
    ;   File0 = '~/.typhon.cookie'
    ),
    expand_file_name(File0, [File|_]).

read_cookie(File, Cookie) :-
    check_private(File),
    setup_call_cleanup(
        open(File, read, In),
        read_string(In, "\n", "\r", _, Line),
        close(In)),
    (   string_length(Line, Length),
        Length >= 16
    ->  Cookie = Line
    ;   unfit(File, 'its first line has less than 16 characters; without \c
                    the file a new one is made')
    ).

unfit(File, Why) :-
    throw(error(permission_error(use, cookie_file, File), context(_, Why))).

%   Prolog has no predicate for the mode of a file; ls prints it, as -rw-------,
%   on all systems with modes. A pipe needs no library(process), which is as
%   large as three modules of this library.

check_private(_) :-
    current_prolog_flag(windows, true),
    !.
check_private(File) :-
    shell_word(File, Word),
    atom_concat('exec ls -lnd -- ', Word, Command),
    setup_call_cleanup(
        open(pipe(Command), read, Out),
        read_string(Out, "\n", "\r", _, Line),
        close(Out)),
    (   sub_string(Line, 4, 6, _, "------")
    ->  true
    ;   format(atom(Why), 'others may use it: chmod 600 ~w', [File]),
        unfit(File, Why)
    ).

%   A quote inside quotes is written '\''.

shell_word(Text, Word) :-
    atomic_list_concat(Parts, '\'', Text),
    atomic_list_concat(Parts, '\'\\\'\'', Inside),
    atomic_list_concat(['\'', Inside, '\''], Word).

%   The file appears complete and private, or not at all: it is written in
%   a closed directory and linked to its name, which fails for all but the
%   first of the processes that try at once.

make_cookie(File) :-
    random_hex(8, Suffix),
    atomic_list_concat([File, '.', Suffix], Directory),
    setup_call_cleanup(
        make_directory(Directory),
        make_cookie_in(Directory, File),
        delete_directory_and_contents(Directory)).

make_cookie_in(Directory, File) :-
    chmod(Directory, 0o700),
    atom_concat(Directory, '/cookie', New),
    random_hex(32, Cookie),
    setup_call_cleanup(
        open(New, write, Out),
        format(Out, "~w~n", [Cookie]),
        close(Out)),
    chmod(New, 0o600),
    catch(link_file(New, File, hard), error(Formal, Context), true),
    (   exists_file(File)
    ->  true
    ;   throw(error(Formal, Context))
    ).
