:- module(typhon_page_editor,
          [ editor_start/0,
            editor_stop/0,
            program_at/2,               % +Message, -Spec
            text_file/3,                % +Text, +Name, -File
            problem_dicts/2,            % +Messages, -Dicts
            without_folder/2,           % +Text, -Short
            read_text/3,                % +Field, +Text, -Term
            text_in/3,                  % +Key, +Message, -Text
            name_in/3,                  % +Key, +Message, -Name
            term_in/4,                  % +Key, +Message, +Default, -Term
            saying/2,                   % :Goal, -Messages
            on_console/1                % :Goal
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(filesex),
              [ delete_directory_and_contents/1, directory_file_path/3,
                make_directory_path/1 ]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../kernel/base/private', [private_folder/2, private_new/2]).

/** <module> Texts that a browser sends, and messages printed for it

A text that a browser sends becomes a file, in a folder that exists as long as
the page, so that it is read, checked and reported on like other programs.  The
same text always becomes the same file.

Messages of a thread that serves a browser are kept for that browser, and not
printed at the terminal.

*Threading*: any thread.  Each text has its own folder, and messages are kept
for each thread.
*/

:- dynamic folder/1.

%!  editor_start is det.
%!  editor_stop is det.
%
%   Create the folder for texts; delete it with its files.

editor_start :-
    tmp_file(typhon_page, Prefix),
    private_folder(Prefix, Folder),
    assertz(folder(Folder)).

editor_stop :-
    forall(retract(folder(Folder)),
           delete_directory_and_contents(Folder)).

%!  program_at(+Message:dict, -Spec) is det.
%
%   Spec is the program that Message names: a file with the field `text`, or the
%   field `program`, a file or a term like agents(census).

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
%
%   File is a file Name that contains Text, in a folder of its own.

text_file(Text, Name, File) :-
    folder(Folder),
    variant_sha1(Text, Hash),
    directory_file_path(Folder, Hash, Own),
    directory_file_path(Own, Name, File),
    make_directory_path(Own),
    private_new(File, Text),
    (   read_file_to_string(File, Text, [encoding(utf8)])
    ->  true
    ;   permission_error(create, program, File)     % another text is there
    ).

%!  problem_dicts(+Messages, -Dicts) is det.
%
%   Dicts are _{kind, line, text} for the Messages of saying/2; the line is 0 if
%   a message has none.

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

%   The line has a field of its own, so the text does not repeat it.

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
%   Short is Text without the folder of the editor, which users need not see.

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

                /*******************************
                *            TERMS             *
                *******************************/

:- multifile
    prolog:error_message//1.

%!  text_in(+Key, +Message:dict, -Text:string) is det.
%!  name_in(+Key, +Message:dict, -Name:atom) is det.
%!  term_in(+Key, +Message:dict, +Default, -Term) is det.
%
%   Text, Name or Term is the field Key of Message.  Term is read from the text
%   of the field, and is Default if the field is missing or empty; an unbound
%   Default makes the field mandatory.
%
%   @error existence_error(page_field, Key), page_syntax(Key, Error, Where)

text_in(Key, Message, Text) :-
    (   get_dict(Key, Message, Text0)
    ->  must_be(string, Text0),
        Text = Text0
    ;   existence_error(page_field, Key)
    ).

name_in(Key, Message, Name) :-
    text_in(Key, Message, Text),
    (   Text == ""
    ->  existence_error(page_field, Key)
    ;   atom_string(Name, Text)
    ).

term_in(Key, Message, Default, Term) :-
    (   get_dict(Key, Message, Text),
        must_be(string, Text),
        split_string(Text, " \n\t", " \n\t", Parts),
        Parts \== [""]
    ->  read_text(Key, Text, Term)
    ;   nonvar(Default)
    ->  Term = Default
    ;   existence_error(page_field, Key)
    ).

%!  read_text(+Field, +Text, -Term) is det.
%
%   Term is read from Text.
%
%   @error page_syntax(Field, Error, Where)

read_text(Field, Text, Term) :-
    catch(term_string(Term, Text),
          error(syntax_error(Error), Where),
          throw(error(page_syntax(Field, syntax_error(Error), Where), _))).

prolog:error_message(page_syntax(Field, Error, Where)) -->
    { syntax_text(Error, Text),
      place_text(Where, Place)
    },
    [ 'the ~w cannot be read: ~w~w'-[Field, Text, Place] ].
prolog:error_message(existence_error(page_field, Field)) -->
    [ 'the ~w is missing'-[Field] ].

syntax_text(syntax_error(Error), Text) :-
    phrase('$messages':syntax_error(Error), Lines),
    lines_text(Lines, Text).

lines_text(Lines, Text) :-
    with_output_to(string(Text0),
                   print_message_lines(current_output, '', Lines)),
    split_string(Text0, "", " \n", [Text]).

%   Place is the position of a syntax error that term_string/2 raises.

place_text(string(Text, Position), Place) :-
    string_length(Text, Length),
    At is min(Position, Length),
    Start is max(0, At-20),
    Count is At-Start,
    sub_string(Text, Start, Count, _, Before),
    sub_string(Text, At, _, 0, After0),
    split_string(After0, "", " .", [After]),
    format(string(Place), ', at "~w ** here ** ~w"', [Before, After]).

                /*******************************
                *           MESSAGES           *
                *******************************/

:- meta_predicate
    saying(0, -),
    on_console(0).

:- thread_local said/3.                 % Kind, Term, Text

:- multifile user:thread_message_hook/3.
:- thread_local user:thread_message_hook/3.

%!  saying(:Goal, -Messages:list) is semidet.
%
%   As once(Goal).  Messages are the errors and warnings that it prints in this
%   thread, terms said(Kind, Term, Text).  They are not printed, and neither are
%   informational messages.

saying(Goal, Messages) :-
    retractall(said(_, _, _)),
    setup_call_cleanup(
        assertz((user:thread_message_hook(Term, Kind, Lines) :-
                     typhon_page_editor:keep_message(Kind, Term, Lines)), Hook),
        once(Goal),
        erase(Hook)),
    findall(said(Kind, Term, Text), retract(said(Kind, Term, Text)),
            Messages).

:- public keep_message/3.

keep_message(informational, _, _) :-
    !.
keep_message(Kind, Term, Lines) :-
    memberchk(Kind, [error, warning]),
    lines_text(Lines, Text),
    assertz(said(Kind, Term, Text)).

%!  on_console(:Goal) is semidet.
%
%   As once(Goal), with the output of the process as current output.  Threads
%   that Goal creates inherit the current output, and that of a request is
%   closed when the request ends.

on_console(Goal) :-
    current_output(Out),
    setup_call_cleanup(
        set_output(user_output),
        once(Goal),
        set_output(Out)).
