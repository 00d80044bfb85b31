:- module(typhon_error_lines, []).
:- use_module(library(lists), [append/3]).
:- use_module('../kernel/base/error_text', [context_indicator/3, is_remark/1]).

/** <module> Texts of errors of ISO and SWI-Prolog

This module has clauses for the errors of ISO and of SWI-Prolog.  Errors of this
library have clauses of prolog:error_message//1; all other errors are written as
terms.  See typhon_error_text.

*Threading*: pure.
*/

:- multifile
    prolog:error_message//1,
    typhon_error_text:lines//1,
    typhon_error_text:formal_lines//1.

:- dynamic library/1.

:- module_property(typhon_error_lines, file(Source)),
   file_directory_name(Source, Dir),
   absolute_file_name('../../..', Root,
                      [relative_to(Dir), file_type(directory)]),
   retractall(library(_)),
   assertz(library(Root)).

typhon_error_text:lines(Ball) -->
    { var(Ball) },
    !,
    [ 'Unhandled exception: ~p'-[Ball] ].
typhon_error_text:lines(error(Formal, Context)) -->
    !,
    location(Context),
    formal(Formal),
    extra(Context).
typhon_error_text:lines('$aborted') -->
    !,
    [ 'Execution Aborted' ].
typhon_error_text:lines(Ball) -->
    [ 'Unhandled exception: ~p'-[Ball] ].

formal(Formal) -->
    formal_message(Formal),
    !.
formal(Formal) -->
    [ 'Unknown error term: ~p'-[Formal] ].

%   typhon_error_text:formal_lines//1 fails for errors that this library does
%   not translate.

typhon_error_text:formal_lines(Formal) -->
    formal_message(Formal).

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
