:- module(typhon_text,
          [ term_text/2,                % +Term, -Bytes
            text_term/2,                % +Bytes, -Term
            write_portable/3,           % +Out, +Term, +Options
            print_clause/3,             % +Out, +Clause, +Options
            is_printable/1,             % +Text
            shown_text/2,               % +Text, -Shown
            shown_text/3,               % +Text, +Longest, -Shown
            lines_shown/2,              % +Text, -Shown
            formatted/3,                % +Format, +Args, -Text
            format_shown/2,             % +Format, +Args
            format_shown/3,             % +Out, +Format, +Args
            shown_lines/2,              % +Lines0, -Lines
            shell_word/2                % +Text, -Word
          ]).

/** <module> The canonical text of a term, and text as it may be printed

Text that any SWI-Prolog of any word size reads back as the same term, whatever
operators and flags either side has set: functional notation, special floats
spelled out, UTF-8. Characters beyond ASCII are quoted, because versions
disagree on those that need quotes. Those that are not letters are written as
escape sequences, because 10.1 cannot read some of them in quotes.

Text that agents or peers chose may hold characters that control a terminal,
begin a line, or hide other text.  shown_text/2 writes them as escape sequences.
All messages, tables and output of child processes pass
through it.

A clause of prolog:message//1, which comes first, translates messages of this
library and errors by the other clauses, and writes characters that control the
terminal, or hide text, as escape sequences.  So texts of messages
may use ~w and ~p for any term.  Errors of SWI-Prolog are included, since an
agent or a peer may have raised them.

*Threading*: no shared state. The flags for writing and reading are local to a
thread and are restored; so is the variable of shown lines.
*/

:- use_module(library(apply), [maplist/3]).
:- autoload(library(error), [resource_error/1, syntax_error/1]).
:- autoload(library(listing), [portray_clause/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- autoload(library(memfile),
            [ free_memory_file/1, memory_file_to_string/3, new_memory_file/1,
              open_memory_file/4 ]).

:- dynamic user:exception/3.

:- multifile
    user:exception/3,
    prolog:message//1,
    prolog:message_line_element/2.

:- public filtered//1.

% Terms are read in a module of their own: it inherits from system, so that
% operators in user do not reach it, and switches off those of system.

bare_syntax :-
    Module = typhon_text_syntax,
    set_module(Module:base(system)),
    forall(( current_op(Priority, Type, Module:Name),
             Priority > 0,
             Name \== (',')
           ),
           op(0, Type, Module:Name)).

:- bare_syntax.

%!  term_text(+Term, -Bytes:string) is det.
%
%   Bytes are the text of Term. Term must be mobile, see mobile_term/1 of the
%   wire.

term_text(Term, Bytes) :-
    text_options(Options),
    plain_flags(with_output_to(string(Text), write_term(Term, Options))),
    (   is_ascii(Text)
    ->  Bytes = Text
    ;   portable_bytes(Term, Bytes)
    ).

text_options([ quoted(true), ignore_ops(true), fullstop(true),
               module(typhon_text_syntax) ]).

portable_options([ quoted(true), ignore_ops(true), numbervars(false),
                   module(typhon_text_syntax),
                   portray_goal(typhon_text:portable) ]).

portable_bytes(Term, Bytes) :-
    setup_call_cleanup(
        new_memory_file(File),
        ( setup_call_cleanup(
              open_memory_file(File, write, Out, [encoding(utf8)]),
              plain_flags(write_portable(Out, Term,
                                         [ ignore_ops(true), fullstop(true),
                                           module(typhon_text_syntax) ])),
              close(Out)),
          memory_file_to_string(File, Bytes, octet)
        ),
        free_memory_file(File)).

%   Characters beyond ASCII take several bytes in UTF-8: a null stream counts
%   the bytes.

is_ascii(Text) :-
    setup_call_cleanup(
        open_null_stream(Null),
        ( write(Null, Text), byte_count(Null, Bytes) ),
        close(Null)),
    string_length(Text, Bytes).

%!  write_portable(+Out, +Term, +Options) is det.
%
%   As write_term/3, quoted, such that every version can read it.
%
%   @error resource_error(c_stack) if arguments are more than 10,000 deep: a
%          stack of 8 MB reads about that. A portray goal that runs out of
%          stack aborts the process, so it is not called.

write_portable(Out, Term, Options) :-
    (   within_depth(Term, 10 000)
    ->  write_term(Out, Term,
                   [ quoted(true), numbervars(false),
                     portray_goal(typhon_text:portable)
                   | Options ])
    ;   resource_error(c_stack)
    ).

%   The tail of a list is no deeper than the list.

within_depth(Term, _) :-
    \+ compound(Term),
    !.
within_depth([Head|Tail], Depth) :-
    !,
    Depth > 0,
    Below is Depth-1,
    within_depth(Head, Below),
    within_depth(Tail, Depth).
within_depth(Term, Depth) :-
    Depth > 0,
    Below is Depth-1,
    forall(arg(_, Term, Arg), within_depth(Arg, Below)).

%   portable(+Term, +Options): the portray goal. Fails if Term has no
%   characters beyond ASCII outside of its arguments.

portable(Term, _) :-
    atom(Term),
    !,
    foreign_codes(Term, Codes),
    write_codes(0'\', Codes).
portable(Term, _) :-
    string(Term),
    !,
    foreign_codes(Term, Codes),
    write_codes(0'", Codes).
portable(Term, _) :-
    compound(Term),
    compound_name_arguments(Term, Name, Args),
    foreign_codes(Name, Codes),
    write_codes(0'\', Codes),
    put_char('('),
    portable_options(Options),
    write_arguments(Args, Options),
    put_char(')').

foreign_codes(Text, Codes) :-
    string_codes(Text, Codes),
    member(Code, Codes),
    Code > 127,
    !.

write_codes(Quote, Codes) :-
    put_char(Quote),
    forall(member(Code, Codes), write_code(Code, Quote)),
    put_char(Quote).

%   Codes are not written as \xHH\, which cannot be read back if HH begins with
%   d8 to df.

write_code(Code, Quote) :-
    plain_code(Code),
    Code =\= Quote,
    !,
    put_char(Code).
write_code(Code, _) :-
    Code =< 0xffff,
    !,
    format("\\u~|~`0t~16r~4+", [Code]).
write_code(Code, _) :-
    format("\\U~|~`0t~16r~8+", [Code]).

plain_code(Code) :-
    Code =< 126,
    !,
    Code >= 32,
    Code =\= 0'\\.
plain_code(Code) :-
    code_type(Code, alnum).

write_arguments([], _).
write_arguments([Arg|Args], Options) :-
    write_term(Arg, Options),
    forall(member(Next, Args),
           ( put_char(','), write_term(Next, Options) )).

%!  text_term(+Bytes, -Term) is det.
%
%   After the text of Term there may be one blank or newline, and nothing else.
%
%   @error syntax_error(Message)

text_term(Bytes, Term) :-
    (   is_ascii(Bytes)
    ->  setup_call_cleanup(
            open_string(Bytes, In),
            plain_flags(read_text(In, Term)),
            close(In))
    ;   setup_call_cleanup(
            new_memory_file(File),
            ( file_bytes(File, Bytes),
              setup_call_cleanup(
                  open_memory_file(File, read, In, [encoding(utf8)]),
                  plain_flags(read_text(In, Term)),
                  close(In))
            ),
            free_memory_file(File))
    ).

file_bytes(File, Bytes) :-
    setup_call_cleanup(
        open_memory_file(File, write, Out, [encoding(octet)]),
        write(Out, Bytes),
        close(Out)).

read_text(In, Term) :-
    syntax(Options),
    read_term(In, Term, Options),
    read_string(In, _, Rest),
    (   memberchk(Rest, ["", " ", "\n"])
    ->  true
    ;   syntax_error(end_of_file_expected)
    ).

%   The options are in a predicate, because check/0 of 9.2 takes
%   double_quotes/1 for a boolean.

syntax([ module(typhon_text_syntax),
         double_quotes(string),
         back_quotes(codes),
         syntax_errors(error)
       ]).

%   The text does not depend on flags that the user's program has set.

plain_flag(float_format, '').
plain_flag(character_escapes, true).
plain_flag(rational_syntax, compatibility).

plain_flags(Goal) :-
    long_integers,
    (   changed_flag(_, _)
    ->  findall(Flag-Value, changed_flag(Flag, Value), Changed),
        setup_call_cleanup(
            forall(( member(Flag-_, Changed), plain_flag(Flag, Plain) ),
                   set_prolog_flag(Flag, Plain)),
            call(Goal),
            forall(member(Flag-Value, Changed),
                   set_prolog_flag(Flag, Value)))
    ;   call(Goal)
    ).

changed_flag(Flag, Value) :-
    plain_flag(Flag, Plain),
    current_prolog_flag(Flag, Value),
    Value \== Plain.

%   In threads of 9.2 this limit is 0, and no integer beyond it can be written.

long_integers :-
    (   current_prolog_flag(max_integer_size, 0)
    ->  set_prolog_flag(max_integer_size, 1 000 000 000)
    ;   true
    ).

                /*******************************
                *        TEXT FOR PEOPLE       *
                *******************************/

%!  print_clause(+Out, +Clause, +Options) is det.
%
%   As portray_clause/3, but loads no library.  portray_clause/3 looks up the
%   goals of Clause in a module, here one where nothing is autoloaded.

print_clause(Out, Clause, Options) :-
    portray_clause(Out, Clause, [module(typhon_print_clause)|Options]).

user:exception(undefined_predicate, typhon_print_clause:_, error).

                /*******************************
                *          SHOWN TEXT          *
                *******************************/

%!  format_shown(+Format, +Args:list) is det.
%!  format_shown(+Out, +Format, +Args:list) is det.
%!  formatted(+Format, +Args, -Text:string) is det.
%
%   As format/2,3, with escape sequences for characters of Args that
%   is_printable/1 excludes.  Only Format can break lines.

format_shown(Format, Args) :-
    format_shown(current_output, Format, Args).

format_shown(Out, Format, Args) :-
    formatted(Format, Args, Text),
    write(Out, Text).

formatted(Format, Args0, Text) :-
    (   breaks_lines(Format),
        is_list(Args0)
    ->  maplist(argument_shown, Args0, Args),
        format(string(Text0), Format, Args),
        lines_shown(Text0, Text)
    ;   format(string(Text0), Format, Args0),
        shown_text(Text0, Text)
    ).

breaks_lines(Format) :-
    member(Break, ['\n', '~n', '~2n', '~N', '~@']),
    sub_atom(Format, _, _, _, Break),
    !.

%   The type of Arg matters to ~q.

argument_shown(Arg, Shown) :-
    atom(Arg),
    !,
    shown_text(Arg, Text),
    ( atom_string(Arg, Text) -> Shown = Arg ; atom_string(Shown, Text) ).
argument_shown(Arg, Shown) :-
    string(Arg),
    !,
    shown_text(Arg, Shown).
argument_shown(Arg, Arg).

%!  lines_shown(+Text, -Shown:string) is det.
%
%   As shown_text/2, for each line of Text.

lines_shown(Text, Shown) :-
    split_string(Text, "\n", "", Lines0),
    maplist(shown_text, Lines0, Lines),
    atomic_list_concat(Lines, '\n', Atom),
    atom_string(Atom, Shown).

%!  shown_text(+Text, -Shown:string) is det.
%!  shown_text(+Text, +Longest, -Shown:string) is det.
%
%   Shown is Text with escape sequences for characters that is_printable/1
%   excludes, and at most Longest (10,000) characters: longer text ends with
%   three dots.

shown_text(Text, Shown) :-
    shown_text(Text, 10 000, Shown).

shown_text(Text, Longest, Shown) :-
    cut_off(Text, Longest, Begin),
    (   is_printable(Begin)
    ->  Shown = Begin
    ;   string_codes(Begin, Codes),
        with_output_to(string(Escaped),
                       forall(member(Code, Codes), show_code(Code))),
        cut_off(Escaped, Longest, Shown)
    ).

cut_off(Text, Longest, Cut) :-
    (   sub_string(Text, 0, Longest, After, _),
        After > 0
    ->  Length is max(0, Longest-3),
        sub_string(Text, 0, Length, _, Begin),
        string_concat(Begin, "...", Cut)
    ;   text_to_string(Text, Cut)
    ).

show_code(0'\n) :- !, write('\\n').
show_code(0'\t) :- !, write('\\t').
show_code(Code) :-
    (   is_hidden(Code)
    ->  format('\\x~16R\\', [Code])
    ;   put_char(Code)
    ).

%!  is_printable(+Text) is semidet.
%
%   Text, an atom or string, has no control characters, and no invisible ones,
%   such as those that change the direction of text.  Zero bytes are tested
%   apart because split_string/4 ignores them as padding.

is_printable(Text) :-
    \+ sub_atom(Text, _, _, _, '\000\'),
    (   printable_ascii(Ascii),
        split_string(Text, "", Ascii, [""])     % in one call of C
    ->  true
    ;   string_codes(Text, Codes),
        \+ ( member(Code, Codes), is_hidden(Code) )
    ).

printable_ascii(" !\"#$%&'()*+,-./0123456789:;<=>?@\c
                 ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`abcdefghijklmnopqrstuvwxyz{|}~").

is_hidden(Code) :-
    hidden(First, Last),
    Code >= First,
    Code =< Last,
    !.

%   Controls, line separators, the format characters of Unicode (category Cf),
%   other invisible ones, surrogate halves, and codes that are no characters.

hidden(0, 31).
hidden(127, 159).
hidden(0xad, 0xad).
hidden(0x34f, 0x34f).
hidden(0x600, 0x605).
hidden(0x61c, 0x61c).
hidden(0x6dd, 0x6dd).
hidden(0x70f, 0x70f).
hidden(0x890, 0x891).
hidden(0x8e2, 0x8e2).
hidden(0x115f, 0x1160).
hidden(0x17b4, 0x17b5).
hidden(0x180b, 0x180f).
hidden(0x200b, 0x200f).
hidden(0x2028, 0x202e).
hidden(0x2060, 0x206f).
hidden(0x3164, 0x3164).
hidden(0xd800, 0xdfff).
hidden(0xfeff, 0xfeff).
hidden(0xffa0, 0xffa0).
hidden(0xfff0, 0xfffb).
hidden(0xfffe, 0xffff).
hidden(0x110bd, 0x110bd).
hidden(0x110cd, 0x110cd).
hidden(0x13430, 0x1343f).
hidden(0x1bca0, 0x1bca3).
hidden(0x1d173, 0x1d17a).
hidden(0xe0000, 0xe0fff).

                /*******************************
                *     LINES THAT ARE SHOWN     *
                *******************************/

prolog:message(Term) -->
    typhon_text:filtered(Term).

%   filtered(+Term)//: fails while it runs, so that the other clauses translate.

filtered(Term, Lines, Rest) :-
    passes(Term),
    \+ nb_current(typhon_filtering, true),
    b_setval(typhon_filtering, true),
    prolog:translate_message(Term, Lines0, []),
    b_setval(typhon_filtering, false),
    !,
    shown_lines(Lines0, Shown),
    append(Shown, Rest, Lines).

passes(typhon(_)).
passes(error(_, _)).
passes(unhandled_exception(_)).

%   library(debug) translates messages of debug/3 itself.  Their arguments may
%   hold newlines.

prolog:message_line_element(Out, Format-Args) :-
    nb_current(prolog_debug_printing, true),
    catch(format(string(Text0), Format, Args), error(_, _), fail),
    lines_shown(Text0, Text),
    write(Out, Text).

%!  shown_lines(+Lines0:list, -Lines:list) is det.
%
%   Lines are the message lines Lines0 with escape sequences, see shown_text/2.
%   Elements without such text are the same in both.

shown_lines(Lines0, Lines) :-
    maplist(shown_element, Lines0, Lines).

shown_element(Element0, Element) :-
    nonvar(Element0),
    parts(Element0, Format, Args, Other, Text),
    catch(( format(string(Text0), Format, Args),
            formatted(Format, Args, Text) ),
          error(_, _), fail),           % print_message/2 reports that
    Text \== Text0,
    !,
    Element = Other.
shown_element(Element, Element).

%   parts(+Element, -Format, -Args, -Other, -Text): Element prints Args by
%   Format; Other prints Text instead.

parts(Format-Args, Format, Args, '~w'-[Text], Text) :- !.
parts(ansi(Style, Format, Args), Format, Args, ansi(Style, '~w', [Text]),
      Text) :- !.
parts(url(Place), '~w', [Place], '~w'-[Text], Text) :- !.
parts(url(Place, Label), '~w ~w', [Place, Text0], '~w'-[Text], Text) :-
    !,
    ( Label = Format-Args -> format(string(Text0), Format, Args)
    ; Text0 = Label ).
parts(Format, Format, [], '~w'-[Text], Text) :-
    ( atom(Format) ; string(Format) ),
    \+ memberchk(Format, [nl, flush, full_stop, at_same_line]).

                /*******************************
                *            SHELLS            *
                *******************************/

%!  shell_word(+Text, -Word:atom) is det.
%
%   A POSIX shell reads Word as Text.  A quote inside quotes is written '\''.

shell_word(Text, Word) :-
    atomic_list_concat(Parts, '\'', Text),
    atomic_list_concat(Parts, '\'\\\'\'', Inside),
    atomic_list_concat(['\'', Inside, '\''], Word).
