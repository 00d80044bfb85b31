:- use_module('../lib/common', [project_file/2]).
:- use_module('../lib/virtual_documents').
:- use_module('../lib/documents', [blocks/2]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, make_directory_path/1]).

/*  swipl -g play -t halt test/portability/player.pl -- DOCUMENT FOLDER

    plays the sessions of DOCUMENT in FOLDER, a new one, and writes what is in it
    then as a term.  Processes of another Prolog have no file in common with the
    suite that starts them. */

play :-
    current_prolog_flag(argv, [Document, Dir]),
    project_file(Document, File),
    project_file(prolog, Library),
    project_file('test/lib/wasm/play.pl', Play),
    asserta(user:file_search_path(library, Library)),
    make_directory_path(Dir),
    call_cleanup(( blocks(File, Blocks),
                   session_write(Blocks, Dir),
                   consult(Play),
                   working_directory(Old, Old),
                   play(Dir),
                   working_directory(_, Old),
                   folder_contents(Dir, Contents) ),
                 delete_directory_and_contents(Dir)),
    format('~q.~n', [played(Contents)]).
