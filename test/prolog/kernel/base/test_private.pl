:- module(test_private, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/pages', [with_page/3]).
:- use_module('../../../../prolog/typhon/kernel/base/private').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [chmod/2, directory_file_path/3, directory_member/3,
               link_file/3]).
:- use_module(library(lists), [numlist/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(thread), [concurrent_maplist/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire), [cookie/1]).

/** <module> Folders and files that other users cannot read or exchange

*Threading*: one test at a time.
*/

mode(File, Mode) :-
    format(atom(Command), 'ls -ld ~w', [File]),
    setup_call_cleanup(open(pipe(Command), read, In),
                       read_string(In, "\n", "", _, Line),
                       close(In)),
    sub_string(Line, 1, 9, _, Text),
    atom_string(Mode, Text).

in(Dir, Name, File) :-
    directory_file_path(Dir, Name, File).

put(File, Text) :-
    write_file(File, Text).

text(File, Text) :-
    read_file_to_string(File, Text, []).

new_text(File, N, Text) :-
    private_new(File, N),
    text(File, Text).

put_text(Text, File) :-
    put(File, Text).

fails(_) :-
    throw(error(e, _)).

:- begin_tests(private).

test(folder, Modes-Count == ['rwx------','rwx------']-2) :-
    with_tmp_dir(Dir, ( in(Dir, x, Prefix),
                          private_folder(Prefix, A), private_folder(Prefix, B),
                          maplist(mode, [A,B], Modes),
                          sort([A,B], Both), length(Both, Count) )).
test(first_of_many_makes_the_file, Text-Beside == "1"-[]) :-
    with_tmp_dir(Dir, ( in(Dir, x, File),
                          private_new(File, 1), private_new(File, 2),
                          text(File, Text),
                          findall(F, ( directory_member(Dir, F, []),
                                       F \== File ), Beside) )).
test(race, Distinct == 1) :-
    with_tmp_dir(Dir, ( in(Dir, x, File),
                          numlist(1, 16, Ns),
                          concurrent_maplist(new_text(File), Ns, Texts),
                          sort(Texts, Set), length(Set, Distinct) )).
test(link_is_replaced_and_not_followed, Text-Mode == "theirs"-'rw-------') :-
    with_tmp_dir(Dir, ( in(Dir, victim, Victim), put(Victim, theirs),
                          in(Dir, x, File), link_file(Victim, File, symbolic),
                          private_write(File, put_text(ours)),
                          text(Victim, Text), mode(File, Mode) )).
test(file_stays_if_its_writer_fails, Text-Beside == "old"-[]) :-
    with_tmp_dir(Dir, ( in(Dir, x, File), put(File, old),
                          catch(private_write(File, fails),
                                error(e, _), true),
                          text(File, Text),
                          findall(F, ( directory_member(Dir, F, []),
                                       F \== File ), Beside) )).
test(open_makes_private, [A,B] == ['rw-------','rw-------']) :-
    with_tmp_dir(Dir, ( in(Dir, x, File), opened(File, A),
                          in(Dir, y, Old), put(Old, old), chmod(Old, 0o666),
                          opened(Old, B) )).
test(devices_are_left_alone, Mode == 'rw-rw-rw-') :-
    private_open('/dev/null', append, Out, []),
    close(Out),
    mode('/dev/null', Mode).
test(missing_folder, error(existence_error(source_sink, '/nowhere/x'))) :-
    private_open('/nowhere/x', write, _, []).

test(files_of_the_library, Modes == [m,m,m,m]) :-
    with_tmp_dir(written(Files)),
    findall(m, member(_-'rw-------', Files), Modes).
test(cookie_of_another_user,
     [ condition(( current_prolog_flag(unix, true), is_root )),
       error(permission_error(use, cookie_file, _),
             context(_, 'it belongs to another user')) ]) :-
    with_tmp_dir(foreign_cookie).
test(made_cookie, Mode == 'rw-------') :-
    with_tmp_dir(made_cookie(Mode)).
test(text_in_place_of_a_program_is_no_program,
     error(permission_error(create, program, _))) :-
    with_page([], _,
              ( text_file(File), chmod(File, 0o600), put(File, "evil."),
                text_file(_) )).
test(folder_of_texts, Mode == 'rwx------') :-
    with_page([], _,
              ( text_file(File),
                file_directory_name(File, Own),
                file_directory_name(Own, Folder),
                mode(Folder, Mode) )).

text_file(File) :-
    typhon_page_editor:text_file("main.", 'program.pl', File).

:- end_tests(private).

opened(File, Mode) :-
    private_open(File, append, Out, []),
    close(Out),
    mode(File, Mode).

is_root :-
    setup_call_cleanup(open(pipe('id -u'), read, In),
                       read_string(In, "\n", "", _, Line), close(In)),
    Line == "0".

with_cookie_file(File, Goal) :-
    ( getenv('TYPHON_COOKIE', Cookie) -> true ; Cookie = '' ),
    ( getenv('TYPHON_COOKIE_FILE', Old) -> true ; Old = '' ),
    setup_call_cleanup(
        ( setenv('TYPHON_COOKIE', ''), setenv('TYPHON_COOKIE_FILE', File) ),
        Goal,
        ( setenv('TYPHON_COOKIE', Cookie), setenv('TYPHON_COOKIE_FILE', Old) )).

foreign_cookie(Dir) :-
    in(Dir, cookie, File),
    put(File, "0123456789abcdef0123456789abcdef\n"),
    chmod(File, 0o600),
    format(atom(Command), 'chown 12345 ~w', [File]),
    shell(Command),
    with_cookie_file(File, cookie(_)).

made_cookie(Mode, Dir) :-
    in(Dir, cookie, File),
    with_cookie_file(File, cookie(_)),
    mode(File, Mode).

written(Files, Dir) :-
    maplist(in(Dir), [audit,log,agent,net], [Audit,Log,Saved,Net]),
    with_hosts([h-[audit(Audit), tokens([t])]],
               ( catch(create([main], _, [host(h)]), error(_, _), true),
                 create([on_message(_, _)], A, [host(h), tokens([t])]),
                 agent_save(A, Saved) )),
    network_start(ring(2), N, [log(Log)]),
    network_save(N, Net),
    network_stop(N),
    findall(F-M, ( member(F, [Audit,Log,Saved,Net]), mode(F, M) ), Files).
