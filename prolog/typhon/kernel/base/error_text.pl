:- module(typhon_error_text,
          [ error_lines/3,              % +Error, -Lines, ?Rest
            error_text/2,               % +Error, -Text
            print_error/2,              % +Kind, +Error
            term_lines/3,               % +Term, -Lines, ?Rest
            context_indicator/3,        % +PI, -Name, -Arity
            is_remark/1,                % @Text
            is_abort/1,                 % @Ball
            abridged/3,                 % +Term, +Longest, -Text
            harmless_error/2,           % +Ball0, -Ball
            is_tree/2,                  % +Term, +Most
            is_in_itself/1              % +Term
          ]).

/** <module> Errors from elsewhere as text

An error that an agent raises, or that another process answers, is untrusted
data.  print_message/2 would run parts of it: it prints format(Format, Args)
with these arguments, and ~@ calls one of them.  So this module converts an
error to text by the hook lines//1.  No hook for printing (portray/1,
attributes) sees a part of the error, and a large term is not written.

An error that another process answers is raised in the thread that asked, and
the top level prints it by the translations of SWI-Prolog and its libraries.
Some of these call parts of an error; harmless_error/2 finds such errors.

*Threading*: pure, except for a flag that is local to the thread.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(text, [shown_lines/2]).

:- meta_predicate plainly(//, -).

:- multifile
    lines//1,                           % +Error: the lines of its message
    prolog:message//1,
    formal_lines//1,                    % +Formal: of an error of ISO, SWI-Prolog or
                                        % this library
    prolog:error_message//1.

%!  print_error(+Kind, +Error) is det.
%
%   Print an exception of any origin.

print_error(Kind, Error) :-
    print_message(Kind, typhon(raised(Error))).

prolog:message(typhon(raised(Error))) -->
    error_lines(Error).

%!  is_abort(@Ball) is semidet.
%
%   Ball is the exception of an abort: it ends the thread that catches it.

is_abort(Ball) :-
    nonvar(Ball),
    ends_thread(Ball).

ends_thread('$aborted').
ends_thread(unwind(_)).                 % SWI-Prolog 9.3 and later

%!  error_lines(+Error, -Lines, ?Rest) is det.
%
%   Lines are the message, as of prolog:message//1.

error_lines(Error) -->
    { error_text(Error, Text),
      split_string(Text, "\n", "", Lines)
    },
    text_lines(Lines).

text_lines([Line]) -->
    !,
    [ '~w'-[Line] ].
text_lines([Line|Lines]) -->
    [ '~w'-[Line], nl ],
    text_lines(Lines).

%!  error_text(+Error, -Text:string) is det.
%
%   Text is the message of Error, an exception of any origin.

error_text(Error, Text) :-
    (   is_tree(Error, 50 000)
    ->  plainly(message(Error), Text)
    ;   Error = error(Formal, _),
        is_tree(Formal, 50 000)
    ->  plainly(message(error(Formal, _)), Text)
    ;   large_text(Error, Text)
    ).

message(Error) -->
    lines(Error),
    !.
message(Error) -->                      % no loaded code translates it
    [ '~p'-[Error] ].

large_text(Term, Text) :-
    (   callable(Term)
    ->  functor(Term, Name, Arity),
        format(string(Text), 'a large term, ~q', [Name/Arity])
    ;   Text = "a large term"
    ).

%   plainly(:Message, -Text): Text is the text of the lines of Message, written
%   without hooks.

plainly(Message, Text) :-
    plain_options(Options),
    current_prolog_flag(print_write_options, Old),
    setup_call_cleanup(
        set_prolog_flag(print_write_options, Options),
        ( phrase(Message, Lines0),
          shown_lines(Lines0, Lines),
          with_output_to(string(Text0),
                         print_message_lines(current_output, '', Lines)) ),
        set_prolog_flag(print_write_options, Old)),
    split_string(Text0, "", " \n", [Text]).

plain_options([quoted(true), numbervars(true), portray(false)]).

%!  term_lines(+Term, -Lines, ?Rest) is det.
%
%   Lines print Term as data: no hook is called.

term_lines(Term) -->
    { is_tree(Term, 200 000) },
    !,
    [ '~W'-[Term, Options] ],
    { plain_options(Options) }.
term_lines(Term) -->
    { large_text(Term, Text) },
    [ '~w'-[Text] ].

%!  context_indicator(+PI, -Name, -Arity) is semidet.
%
%   PI, that is Name/Arity, is a predicate indicator that may be in the context
%   of an error.

context_indicator(PI0, Name, Arity) :-
    nonvar(PI0),
    (   PI0 = Module:PI,
        memberchk(Module, [system, user])
    ->  true
    ;   PI = PI0
    ),
    nonvar(PI),
    PI = Name0/Arity,
    integer(Arity),
    (   atom(Name0)
    ->  Name = Name0
    ;   nonvar(Name0),
        Name0 = M:N,
        atom(M),
        atom(N),
        Name = Name0
    ).

%!  is_remark(@Text) is semidet.
%
%   Text is a remark that may be in the context of an error.

is_remark(Text) :-
    ( atom(Text) ; string(Text) ),
    !,
    Text \== '',
    Text \== "".

                /*******************************
                *           ABRIDGED           *
                *******************************/

%!  abridged(+Term, +Longest:integer, -Text:string) is det.
%
%   Text is Term as written in a program: a variable that occurs once as `_`,
%   the others as letters.  Text longer than Longest characters is cut off, and
%   ends with three dots.  Deep and cyclic terms are cut off during the
%   traversal, so that a large term costs no more than its text.

abridged(Term, Longest, Text) :-
    copy_term(Term, Copy, _),
    named(Copy),
    Depth is max(10, Longest),
    format(string(Whole), '~W',
           [ Copy, [ quoted(true), numbervars(true), portray(false),
                     max_depth(Depth), cycles(true) ] ]),
    (   sub_string(Whole, 0, Longest, After, Begin),
        After > 3
    ->  string_concat(Begin, "...", Text)
    ;   Text = Whole
    ).

named(Term) :-
    cyclic_term(Term),
    !.
named(Term) :-
    term_singletons(Term, Singletons),
    maplist(=('$VAR'('_')), Singletons),
    numbervars(Term, 0, _).

                /*******************************
                *         RAISED AGAIN         *
                *******************************/

%!  harmless_error(+Ball0, -Ball) is det.
%
%   Ball is to be raised here in place of Ball0, which another process raised.
%   If printing Ball0 calls no goal, Ball is the same error with the part of
%   its context that is text.  Else it is error(raised_elsewhere(Ball0), _).

harmless_error(Ball0, Ball) :-
    (   harmless(Ball0, Ball1)
    ->  Ball = Ball1
    ;   Ball = error(raised_elsewhere(Ball0), _)
    ).

harmless(error(Formal, Context0), error(Formal, Context)) :-
    !,
    nonvar(Formal),
    is_tree(Formal, 50 000),
    harmless_formal(Formal),
    harmless_context(Context0, Context).
harmless(Ball, Ball) :-
    nonvar(Ball),
    \+ is_abort(Ball),
    is_tree(Ball, 50 000),
    \+ translated(Ball).

%   SWI-Prolog's messages for these two read the context, or the culprit, too.

harmless_formal(resource_error(What)) :-
    !,
    atom(What),
    What \== stack.
harmless_formal(existence_error(reset, _)) :-
    !,
    fail.
harmless_formal(Formal) :-
    phrase(formal_lines(Formal), _),
    !.
harmless_formal(Formal) :-
    \+ translated(error(Formal, _)).

harmless_context(Context0, Context) :-
    nonvar(Context0),
    Context0 = context(PI0, Text0),
    !,
    ( context_indicator(PI0, _, _) -> PI = PI0 ; true ),
    ( is_remark(Text0) -> Text = Text0 ; true ),
    Context = context(PI, Text).
harmless_context(_, _).

%   translated(+Ball): a hook or SWI-Prolog translates it.  The first two
%   clauses are of translate_message//1 itself, not of a table.

translated(format(_, _)) :-
    !.
translated(message_lines(_)) :-
    !.
translated(Ball) :-
    translating(Ball, Term, Any, Hook),
    catch(accepts(Term, Any, Hook),
          error(permission_error(_, _, _), _), true),   % it is protected
    !.

%   accepts(+Term, ?Any, :Hook): a clause of Hook, whose argument Any is the
%   term, accepts Term.  A clause that accepts any term counts if the predicate
%   to which it passes the term accepts it; that of typhon_text does not.

accepts(Term, Any, Hook) :-
    predicate_property(Hook, defined),
    clause(Hook, Body),
    Body \= typhon_text:_,
    (   var(Any),
        Body = Module:Goal,
        callable(Goal),
        arg(_, Goal, Arg),
        Arg == Any
    ->  accepts(Term, Any, Module:Goal)
    ;   \+ Any \= Term
    ),
    !.

translating(Ball, Ball, Any, Hook) :-
    member(Hook, [ prolog:message(Any, _, _), prolog:message(_, Any, _, _),
                   '$messages':prolog_message(Any, _, _) ]).
translating(error(Formal, _), Formal, Any, Hook) :-
    member(Hook, [ prolog:error_message(Any, _, _),
                   prolog:error_message(_, Any, _, _),
                   '$messages':iso_message(Any, _, _),
                   '$messages':swi_message(Any, _, _) ]).

prolog:error_message(raised_elsewhere(Ball)) -->
    [ 'Raised elsewhere: ~p'-[Ball] ].

                /*******************************
                *    CYCLIC AND DEEP TERMS     *
                *******************************/

%!  is_tree(+Term, +Most) is semidet.
%
%   Term is acyclic, and has at most Most parts when shared parts are written
%   out: forty cells may be a term of 2^40 parts.  Each eight characters of a
%   text, and each eight bytes of an integer, count as a part, too.

is_tree(Term, Most) :-
    acyclic_term(Term),
    tree(Term, Most, _).

tree(Term, N0, N) :-
    (   atom(Term)
    ->  atom_length(Term, Length),
        N is N0-1-Length//8
    ;   integer(Term),
        is_small(Term)
    ->  N is N0-1
    ;   nonvar(Term),
        Term = [Head|Tail]
    ->  N1 is N0-1,
        N1 >= 0,
        tree(Head, N1, N2),
        tree(Tail, N2, N)
    ;   compound(Term)
    ->  compound_name_arity(Term, Name, Arity),
        name_parts(Name, Parts),
        N1 is N0-Parts,
        N1 >= 0,
        arguments(1, Arity, Term, N1, N)
    ;   text_parts(Term, Parts),
        N is N0-Parts
    ),
    N >= 0.

%   The name of a dict is not an atom.

name_parts(Name, Parts) :-
    (   atom(Name)
    ->  atom_length(Name, Length),
        Parts is 1+Length//8
    ;   Parts = 1
    ).

arguments(I, Arity, Term, N0, N) :-
    (   I < Arity
    ->  arg(I, Term, Arg),
        tree(Arg, N0, N1),
        I1 is I+1,
        arguments(I1, Arity, Term, N1, N)
    ;   I =:= Arity
    ->  arg(I, Term, Arg),
        tree(Arg, N0, N)
    ;   N = N0
    ).

%   Strings and integers may be long, too.

text_parts(Term, Parts) :-
    (   integer(Term)
    ->  Parts is 1+msb(abs(Term))//64
    ;   string(Term)
    ->  string_length(Term, Length),
        Parts is 1+Length//8
    ;   rational(Term, N, D)
    ->  Parts is 2+msb(abs(N)+1)//64+msb(D)//64
    ;   Parts = 1
    ).

is_small(Integer) :-
    Integer >= -0x7fff_ffff,
    Integer =< 0x7fff_ffff.

%!  is_in_itself(+Term) is semidet.
%
%   Term is a part of one of its own arguments.  This is a stronger condition
%   than being cyclic: a mark that replaces one argument is then found below
%   the former arguments of Term.

is_in_itself(Term) :-
    cyclic_term(Term),
    \+ \+ ( compound_name_arguments(Term, _, Args),
            setarg(1, Term, Mark),
            term_variables(Args, Variables),
            member(Variable, Variables),
            Variable == Mark ).
