:- module(typhon_text,
          [ term_text/2,                % +Term, -Bytes
            text_term/2                 % +Bytes, -Term
          ]).

/** <module> The canonical text of a term

Text that any SWI-Prolog of any word size reads back as the same term,
whatever operators and flags either side has set: functional notation,
special floats spelled out, UTF-8.

_Threading_: no shared state. The flags that govern writing and reading are
local to a thread and are put back.
*/

:- use_module(library(memfile),
              [ free_memory_file/1, memory_file_to_string/3,
                new_memory_file/1, open_memory_file/3, open_memory_file/4 ]).

% Terms are read in a module of their own: it inherits from system, so
% that nobody's operators in user reach it, and has system's switched off.

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
%   Bytes are the text of Term. Term must be mobile_term/1.

term_text(Term, Bytes) :-
    setup_call_cleanup(
        new_memory_file(File),
        ( setup_call_cleanup(
              open_memory_file(File, write, Out, [encoding(utf8)]),
              plain_flags(write_text(Out, Term)),
              close(Out)),
          memory_file_to_string(File, Bytes, octet)
        ),
        free_memory_file(File)).

write_text(Out, Term) :-
    write_term(Out, Term, [quoted(true), ignore_ops(true), fullstop(true)]).

%!  text_term(+Bytes, -Term) is det.
%
%   @error syntax_error(Message)

text_term(Bytes, Term) :-
    setup_call_cleanup(
        new_memory_file(File),
        ( setup_call_cleanup(
              open_memory_file(File, write, Out, [encoding(octet)]),
              write(Out, Bytes),
              close(Out)),
          setup_call_cleanup(
              open_memory_file(File, read, In, [encoding(utf8)]),
              plain_flags(read_text(In, Term)),
              close(In))
        ),
        free_memory_file(File)).

read_text(In, Term) :-
    syntax(Options),
    read_term(In, Term, Options).

%   Apart, as check/0 of 9.2 takes double_quotes/1 for a boolean.

syntax([ module(typhon_text_syntax),
         double_quotes(string),
         back_quotes(codes),
         syntax_errors(error)
       ]).

%   What a program may have set for itself must not change the text.

plain_flag(float_format, '').
plain_flag(character_escapes, true).
plain_flag(rational_syntax, compatibility).

plain_flags(Goal) :-
    findall(Flag-Value,
            ( plain_flag(Flag, Plain),
              current_prolog_flag(Flag, Value),
              Value \== Plain
            ),
            Changed),
    (   Changed == []
    ->  call(Goal)
    ;   setup_call_cleanup(
            forall(( member(Flag-_, Changed), plain_flag(Flag, Plain) ),
                   set_prolog_flag(Flag, Plain)),
            call(Goal),
            forall(member(Flag-Value, Changed),
                   set_prolog_flag(Flag, Value)))
    ).
