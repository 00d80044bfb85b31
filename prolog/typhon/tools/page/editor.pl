:- module(typhon_page_editor,
          [ editor_start/0,
            editor_stop/0,
            program_at/2,               % +Message, -Spec
            text_file/3,                % +Text, +Name, -File
            problem_dicts/2,            % +Messages, -Dicts
            without_folder/2            % +Text, -Short
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(filesex),
              [ delete_directory_and_contents/1, directory_file_path/3,
                make_directory_path/1 ]).
:- use_module(terms, [read_text/3]).

/** <module> Programs written at a browser

Text that comes from a browser becomes a file, in a folder that is there as
long as the page, so that it is read, checked and told of as other programs
are.  The same text is the same file.

*Threading*: any thread; each text has a folder of its own.
*/

:- dynamic folder/1.

%!  editor_start is det.
%!  editor_stop is det.

editor_start :-
    tmp_file(typhon_page, Folder),
    make_directory_path(Folder),
    assertz(folder(Folder)).

editor_stop :-
    forall(retract(folder(Folder)),
           delete_directory_and_contents(Folder)).

%!  program_at(+Message:dict, -Spec) is det.
%
%   Spec is the program that Message means: a file of its `text`, or what
%   `program` says, a file or a term as agents(census).

program_at(Message, File) :-
    get_dict(text, Message, Text),
    !,
    must_be(string, Text),
    text_file(Text, 'program.pl', File).
program_at(Message, Spec) :-
    get_dict(program, Message, Text),
    must_be(string, Text),
    (   sub_string(Text, _, 1, 0, ")")
    ->  read_text(program, Text, Spec)
    ;   atom_string(Spec, Text)
    ).

%!  text_file(+Text, +Name, -File) is det.

text_file(Text, Name, File) :-
    folder(Folder),
    variant_sha1(Text, Hash),
    directory_file_path(Folder, Hash, Own),
    directory_file_path(Own, Name, File),
    (   exists_file(File)
    ->  true
    ;   make_directory_path(Own),
        setup_call_cleanup(
            open(File, write, Out, [encoding(utf8)]),
            write(Out, Text),
            close(Out))
    ).

%!  problem_dicts(+Messages, -Dicts) is det.
%
%   Dicts are _{kind, line, text} of messages as of saying/2; the line is 0
%   where there is none.

problem_dicts(Messages, Dicts) :-
    maplist(problem_dict, Messages, Dicts).

problem_dict(said(Kind, Term, Text0), _{kind:KindText, line:Line, text:Text}) :-
    atom_string(Kind, KindText),
    without_folder(Text0, Text1),
    (   line_of(Term, Line)
    ->  without_place(Text1, Text)
    ;   Line = 0,
        Text = Text1
    ).

line_of(error(_, at(Location, _, _)), Line) :-
    line_in(Location, Line).
line_of(error(_, Location), Line) :-
    line_in(Location, Line).

line_in(Location, _) :-
    var(Location),
    !,
    fail.
line_in(_:Line, Line) :-
    integer(Line).
line_in(file(_, Line, _, _), Line).

%   The line is reported separately.

without_place(Text0, Text) :-
    string_concat("program.pl:", Rest, Text0),
    sub_string(Rest, Before, 2, After, ": "),
    Before < 12,
    !,
    sub_string(Rest, _, After, 0, Text1),
    split_string(Text1, "", " \n\t", [Text]).
without_place(Text, Text).

%!  without_folder(+Text, -Short) is det.
%
%   Where files of the editor are is of no interest.

without_folder(Text, Short) :-
    folder(Folder),
    sub_string(Text, Before, _, After, Folder),
    !,
    sub_string(Text, 0, Before, _, Start),
    sub_string(Text, _, After, 0, Rest0),
    (   sub_string(Rest0, Hash, 1, More, "/"),
        Hash > 0
    ->  sub_string(Rest0, _, More, 0, Rest1)
    ;   Rest1 = Rest0
    ),
    without_folder(Rest1, Rest),
    string_concat(Start, Rest, Short).
without_folder(Text, Text).
