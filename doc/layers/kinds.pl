:- module(layers_kinds,
          [ kinds_problem/1,            % -Problem
            kinds_file/1,               % -File
            write_kinds/0
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../prolog/typhon/kernel/wire/kinds', [arrives/6]).
:- use_module(tree).

/** <module> What other processes may send, and which module handles it

The declarations of `typhon_kinds` are compared with the clauses of hooks: each
clause handles something that is declared for its module, and each declaration
has a clause.  The table of them in doc/wire.md is made here.

*Threading*: the main thread.
*/

%!  kinds_problem(-Problem) is nondet.

kinds_problem(undeclared(File, Form, Kind:Term)) :-
    handles(File, Form, Kind, Term),
    \+ ( declared(Form, Kind, Term, Module), module_of(File, Module) ).
kinds_problem(not_handled(Module, Form, Kind:Term)) :-
    declared(Form, Kind, Term, Module),
    memberchk(Form, [post, request, hand]),
    \+ ( module_of(File, Module), handles(File, Form, Kind, Term) ).
kinds_problem(stale_kinds) :-
    document(_, _, Old, _),
    table(New),
    Old \== New.

kinds_file(File) :-
    inside('prolog/typhon/kernel/wire/kinds.pl', File).

%   handles(?File, ?Form, ?Kind, ?Term): a clause of a hook in File.

handles(File, Form, Kind, Term) :-
    hook_clause(File, Head),
    handled(Head, Form, Kind, Term),
    layer_file(File, _),
    \+ subsumes_term(Term, question(_, _)).  % see here/3

handled(typhon_endpoint:requested(Kind, Term, _, _), request, Kind, Term).
handled(typhon_endpoint:received(Kind, Term, _), post, Kind, Term).
handled(typhon_endpoint:handed(Kind, Term, _, _), hand, Kind, Term).
handled(typhon_questions:here(Question, _, _), request, agent,
        question(_, Question)).
handled(typhon_orders:carried_out(Order, _, _), request, agent,
        question(_, order(Order))).

declared(Form, Kind, Term, Module) :-
    arrives(Form, Kind, Pattern, _, _, Name),
    general(Pattern, Term),
    atom_concat(typhon_, Name, Module).

%   general(+Pattern, -Term): Term is the most general term of Pattern.

general(_:Type, Term) :-
    !,
    general(Type, Term).
general(Type, _) :-
    memberchk(Type, [name, term, count, positive, number, list(_)]),
    !.
general(Pattern, Term) :-
    compound(Pattern),
    !,
    compound_name_arguments(Pattern, Name, Types),
    maplist(general, Types, Terms),
    compound_name_arguments(Term, Name, Terms).
general(Constant, Constant).

                /*******************************
                *           THE TABLE          *
                *******************************/

%!  write_kinds is det.
%
%   Write the table into doc/wire.md.

write_kinds :-
    document(File, Before, _, After),
    table(Table),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        maplist(write(Out), [Before, Table, After], _),
        close(Out)).

write(Out, Text, written) :-
    write(Out, Text).

%   document(-File, -Before, -Table, -After): the text around the table.

document(File, Before, Table, After) :-
    inside('doc/wire.md', File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    Begin = "<!-- kinds -->\n",
    End = "<!-- end of kinds -->\n",
    sub_string(Text, B, L, _, Begin),
    sub_string(Text, E, _, A, End),
    !,
    From is B+L,
    Length is E-From,
    sub_string(Text, 0, From, _, Before),
    sub_string(Text, From, Length, _, Table),
    string_length(End, EL),
    AL is A+EL,
    sub_string(Text, _, AL, 0, After).

table(Table) :-
    findall(Row,
            ( arrives(Form, Kind, Pattern, Right, Scope, Module),
              row(Form, Kind, Pattern, Right, Scope, Module, Row) ),
            Rows),
    append([["| form | kind | term | right | on | module |\n",
             "| --- | --- | --- | --- | --- | --- |\n"],
            Rows],
           Lines),
    atomics_to_string(Lines, Table).

row(Form, Kind, Pattern, Right, Scope, Module, Row) :-
    shown(Pattern, Term),
    on(Scope, On),
    format(string(Row), "| ~w | `~w` | `~w` | ~w | ~w | ~w |~n",
           [Form, Kind, Term, Right, On, Module]).

shown(_:Type, Shown) :-
    !,
    shown(Type, Shown).
shown(Pattern, Shown) :-
    compound(Pattern),
    !,
    compound_name_arguments(Pattern, Name, Types),
    maplist(shown, Types, Args),
    compound_name_arguments(Shown, Name, Args).
shown(Type, Type).

on(host(_), 'the host').
on(agent(_), 'the agent').
on(all, 'all hosts').
on(some, 'some host').
on(none, '').
