:- module(test_shell_word, []).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(readutil), [read_stream_to_codes/2]).
:- use_module(library(typhon/kernel/base/text), [shell_word/2]).

/** <module> Words of shell commands

*Threading*: one test at a time.
*/

:- begin_tests(shell_word).

test(shell_reads_the_word_as_the_text, Wrong == []) :-
    findall(Text, ( between(1, 20, _), random_text(Text) ), Texts),
    maplist(shell_word, Texts, Words),
    atomic_list_concat(Words, ' ', All),
    atom_concat('printf \'%s\\001\' ', All, Command),
    setup_call_cleanup(
        open(pipe(Command), read, Out),
        read_stream_to_codes(Out, Codes),
        close(Out)),
    atom_codes(Read, Codes),
    atomic_list_concat(Back, '\001\', Read),
    append(Texts, [''], Expected),
    ( Back == Expected -> Wrong = [] ; Wrong = Back-Expected ).

:- end_tests(shell_word).

random_text(Text) :-
    random_between(0, 12, Length),
    length(Chars, Length),
    maplist(random_char, Chars),
    atom_chars(Text, Chars).

random_char(Char) :-
    random_member(Char, [ '\'', '"', '\\', '$', '`', ' ', '\t', '\n', '*', '~',
                          '#', ';', '&', '|', '<', '(', '!', a, 'Z', '0', - ]).
