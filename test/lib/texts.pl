:- module(test_texts,
          [ write_file/2,               % +File, +Text
            write_file/3,               % +File, +Format, +Arguments
            file_lines/2,               % +File, -Lines
            message_text/2              % +Term, -Text
          ]).
:- use_module(library(readutil), [read_file_to_string/3]).

/** <module> Text files and messages

*Threading*: any thread.
*/

%!  write_file(+File, +Text) is det.
%!  write_file(+File, +Format, +Arguments) is det.
%
%   Write File anew, in UTF-8.

write_file(File, Text) :-
    write_file(File, '~w', [Text]).

write_file(File, Format, Arguments) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        format(Out, Format, Arguments),
        close(Out)).

%!  file_lines(+File, -Lines:list(string)) is det.
%
%   The last line is empty if the last character of File ends a line.

file_lines(File, Lines) :-
    read_file_to_string(File, Text, [encoding(utf8)]),
    split_string(Text, "\n", "", Lines).

%!  message_text(+Term, -Text:string) is det.
%
%   What print_message/2 prints for Term, without a prefix.

message_text(Term, Text) :-
    phrase('$messages':translate_message(Term), Lines),
    with_output_to(string(Text),
                   print_message_lines(current_output, '', Lines)).
