:- module(typhon_error_lines,
          [ error_text/2,               % +Error, -Text
            harmless_error/2            % +Ball0, -Ball
          ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(error_text,
              [is_abort/1, is_remark/1, is_tree/2, large_text/2]).
:- use_module(text, [shown_lines/2]).

/** <module> Texts of errors of ISO and SWI-Prolog

This module has clauses for the errors of ISO and of SWI-Prolog.  Errors of this
library have clauses of prolog:error_message//1; all other errors are written as
terms.  See typhon_error_text.

An error that another process answers is raised in the thread that asked, and
the top level prints it by the translations of SWI-Prolog and its libraries.
Some of these call parts of an error; harmless_error/2 finds such errors.

*Threading*: pure, except for a flag that is local to the thread.
*/

:- meta_predicate plainly(//, -).

:- multifile
    typhon_error_text:lines//1,
    prolog:error_message//1.

:- dynamic library/1.

:- module_property(typhon_error_lines, file(Source)),
   file_directory_name(Source, Dir),
   absolute_file_name('../../../..', Root,
                      [relative_to(Dir), file_type(directory)]),
   retractall(library(_)),
   assertz(library(Root)).

typhon_error_text:lines(Error) -->
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

%   plainly(:Message, -Text): Text is the text of the lines of Message, written
%   without hooks.

plainly(Message, Text) :-
    current_prolog_flag(print_write_options, Old),
    setup_call_cleanup(
        set_prolog_flag(print_write_options,
                        [quoted(true), numbervars(true), portray(false)]),
        ( phrase(Message, Lines0),
          shown_lines(Lines0, Lines),
          with_output_to(string(Text0),
                         print_message_lines(current_output, '', Lines)) ),
        set_prolog_flag(print_write_options, Old)),
    split_string(Text0, "", " \n", [Text]).

message(Ball) -->
    { var(Ball) },
    !,
    [ 'Unhandled exception: ~p'-[Ball] ].
message(error(Formal, Context)) -->
    !,
    location(Context),
    formal(Formal),
    extra(Context).
message('$aborted') -->
    !,
    [ 'Execution Aborted' ].
message(Ball) -->
    [ 'Unhandled exception: ~p'-[Ball] ].

formal(Formal) -->
    formal_message(Formal),
    !.
formal(Formal) -->
    [ 'Unknown error term: ~p'-[Formal] ].

%   formal_message//1 fails for errors that this library does not translate.

formal_message(Formal) -->
    { nonvar(Formal) },
    (   ours(prolog:error_message(Formal))
    ;   known(Formal)
    ),
    !.

%   ours(:Hook)//: the text is that of a clause of this library for Hook.

ours(prolog:Hook, Lines, Rest) :-
    Hook =.. List0,
    append(List0, [Lines,Rest], List),
    Goal =.. List,
    catch(clause(prolog:Goal, Body, Clause),
          error(permission_error(_, _, _), _), fail),   % protected predicate
    of_library(Clause),
    call(prolog:Body),
    !.

of_library(Clause) :-
    clause_property(Clause, file(File)),
    library(Root),
    sub_atom(File, 0, _, _, Root).

known(instantiation_error) -->
    [ 'Arguments are not sufficiently instantiated' ].
known(uninstantiation_error(Culprit)) -->
    [ 'Uninstantiated argument expected, found ~p'-[Culprit] ].
known(type_error(evaluable, Culprit)) -->
    { callable(Culprit) },
    !,
    [ 'Arithmetic: `~p'' is not a function'-[Culprit] ].
known(type_error(Type, Culprit)) -->
    { kind_of(Culprit, Kind) },
    [ 'Type error: `~w'' expected, found `~p'' (~w)'-[Type, Culprit, Kind] ].
known(domain_error(Domain, Culprit)) -->
    [ 'Domain error: `~w'' expected, found `~p'''-[Domain, Culprit] ].
known(existence_error(procedure, PI)) -->
    !,
    [ 'Unknown procedure: ~q'-[PI] ].
known(existence_error(matching_rule, Goal)) -->
    !,
    [ 'No rule matches ~p'-[Goal] ].
known(existence_error(Kind, Culprit)) -->
    [ '~w `~p'' does not exist'-[Kind, Culprit] ].
known(existence_error(Kind, Culprit, In)) -->
    [ '~w `~p'' does not exist in ~p'-[Kind, Culprit, In] ].
known(permission_error(Action, Kind, Culprit)) -->
    { kind_named(Kind, Name) },
    [ 'No permission to ~w ~w `~p'''-[Action, Name, Culprit] ].
known(representation_error(What)) -->
    [ 'Cannot represent due to `~w'''-[What] ].
known(evaluation_error(What)) -->
    [ 'Arithmetic: evaluation error: `~p'''-[What] ].
known(resource_error(What)) -->
    [ 'Not enough resources: ~w'-[What] ].
known(syntax_error(What)) -->
    { syntax(What, Text) },
    [ 'Syntax error: ~w'-[Text] ].
known(busy(Kind, Culprit)) -->
    [ '~w `~p'' is busy'-[Kind, Culprit] ].
known(timeout_error(What, Culprit)) -->
    [ 'Timeout in ~w from ~p'-[What, Culprit] ].
known(io_error(What, Culprit)) -->
    [ 'I/O error in ~w on stream ~p'-[What, Culprit] ].
known(socket_error(_, Text)) -->
    [ 'Socket error: ~w'-[Text] ].
known(ssl_error(Id, _, Function, Reason)) -->
    [ 'SSL(~w) ~w: ~w'-[Id, Function, Reason] ].
known(system_error(Text)) -->
    [ 'error in system call: ~w'-[Text] ].
known(shell(What, Command)) -->
    [ 'Could not execute `~w'' (~p)'-[Command, What] ].
known(format(Text)) -->
    [ 'Format error: ~w'-[Text] ].
known(format_argument_type(Directive, Argument)) -->
    [ 'Illegal argument to format sequence ~~~w: ~p'-[Directive, Argument] ].
known(duplicate_key(Key)) -->
    [ 'Duplicate key: ~p'-[Key] ].
known(goal_failed(Goal)) -->
    [ 'goal unexpectedly failed: ~p'-[Goal] ].
known(determinism_error(Goal, Declared, Found, _)) -->
    [ '~p is declared ~w, and was ~w'-[Goal, Declared, Found] ].

kind_named(built_in_procedure, 'built-in predicate') :- !.
kind_named(static_procedure, 'static procedure') :- !.
kind_named(Kind, Kind).

kind_of(Term, 'a var')       :- var(Term), !.
kind_of(Term, 'an integer')  :- integer(Term), !.
kind_of(Term, 'a float')     :- float(Term), !.
kind_of(Term, 'a rational')  :- rational(Term), !.
kind_of(Term, 'a string')    :- string(Term), !.
kind_of([], 'an empty_list') :- !.
kind_of(Term, 'a reserved_symbol') :-
    blob(Term, reserved_symbol),
    !.
kind_of(Term, 'an atom')     :- blob(Term, text), !.
kind_of(Term, 'a blob')      :- atom(Term), !.
kind_of(Term, 'a dict')      :- is_dict(Term), !.
kind_of([_|_], 'a list')     :- !.
kind_of(_, 'a compound').

syntax(cannot_start_term, 'Illegal start of term') :- !.
syntax(operator_clash, 'Operator priority clash') :- !.
syntax(operator_balance, 'Unbalanced operator') :- !.
syntax(end_of_clause, 'Unexpected end of clause') :- !.
syntax(end_of_file, 'Unexpected end of file') :- !.
syntax(list_rest, 'Unexpected comma or bar in rest of list') :- !.
syntax(quoted_punctuation, 'Operand expected, unquoted comma or bar found') :-
    !.
syntax(What, Text) :-
    atom(What),
    sub_atom(What, 0, 1, _, First),
    sub_atom(What, 1, _, 0, Others),
    \+ sub_atom(What, _, _, _, ' '),
    !,
    upcase_atom(First, Upper),
    atomic_list_concat(Parts, '_', Others),
    atomic_list_concat(Parts, ' ', Words),
    atom_concat(Upper, Words, Text).
syntax(What, What).

%   SWI-Prolog may have added the location of an error, and a remark.

location(Context) -->
    { var(Context) },
    !.
location(Context) -->
    ours(prolog:message_location(Context)),
    !.
location(context(PI, _)) -->
    { context_indicator(PI, Name, Arity) },
    !,
    [ '~q/~w: '-[Name, Arity] ].
location(file(File, Line, Position, _)) -->
    { atomic(File), integer(Line), integer(Position) },
    !,
    (   { Position < 0 }
    ->  [ '~w:~d: '-[File, Line] ]
    ;   [ '~w:~d:~d: '-[File, Line, Position] ]
    ).
location(stream(Stream, Line, Position, _)) -->
    { integer(Line), integer(Position) },
    !,
    { named_stream(Stream, Name) },
    [ '~w:~d:~d: '-[Name, Line, Position] ].
location(_) -->
    [].

named_stream(Stream, Name) :-
    (   blob(Stream, stream),
        catch(stream_property(Stream, file_name(File)), error(_, _), fail)
    ->  Name = File
    ;   format(string(Name), 'Stream ~w', [Stream])
    ).

extra(Context) -->
    { var(Context) },
    !.
extra(Context) -->
    ours(prolog:message_context(Context)),
    !.
extra(context(_, Text)) -->
    { is_remark(Text) },
    !,
    [ ' (~w)'-[Text] ].
extra(string(Text, Position)) -->
    { is_remark(Text),
      integer(Position),
      sub_string(Text, 0, Position, _, Before),
      sub_string(Text, Position, _, 0, After)
    },
    !,
    [ nl, '~w'-[Before], nl, '** here **', nl, '~w'-[After] ].
extra(_) -->
    [].

%   context_indicator(+PI, -Name, -Arity) is semidet: PI, that is Name/Arity, is
%   a predicate indicator that may be in the context of an error.

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
    phrase(formal_message(Formal), _),
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
