:- module(typhon_completion,
          [ completed/4                 % +Before, +After, -Delete, -Completions
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(console_input), []).
:- use_module(library(dcg/basics), [eos//0, string_without//2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module('../kernel/base/names', [names/2]).

/** <module> Completion of names at the top level

In an argument that expects the name of a host, an agent, a network or a
program, the tab key completes such names; elsewhere the completion of Prolog
applies.

*Threading*: the thread of the top level.
*/

%!  completed(+Before, +After, -Delete, -Completions) is semidet.
%
%   The cursor is between Before and After.  The arguments are those of
%   prolog:complete_input/4.

completed(Before, After, Delete, Completions) :-
    string_codes(Before, Codes),
    phrase(cursor([], Functor-Argument, Style, Delete), Codes),
    wants(Functor, Argument, Kind),
    names(Kind, Names),
    findall(Text,
            ( offered(Kind, Style, Names, Name),
              sub_atom(Name, 0, _, _, Delete),
              completion(Style, Kind, Name, After, Text) ),
            Completions),
    Completions \== [].

%   wants(+Functor, +Argument, -Kind)

wants(Functor, Argument, Kind) :-
    wanted(Functor, Argument, Kind0),
    !,
    Kind = Kind0.

wanted(agents, 1, agents).
wanted(payloads, 1, payloads).
wanted(host, 1, host).
wanted(remote, 1, host).
wanted(link, _, host).
wanted(unlink, _, host).
wanted(agent_move, 2, host).
wanted(at, 2, host).
wanted(at, 1, agent).
wanted(payload_attach, 1, agent).
wanted(payload_detach, 1, agent).
wanted(Functor, 1, Kind) :-
    member(Kind, [host, agent, network]),
    atom_concat(Kind, '_', Begin),
    sub_atom(Functor, 0, _, _, Begin).

%   offered(+Kind, +Style, +Names, -Name): for an agent, Name is its short name
%   if that is unique, else its id.

offered(agent, plain, Ids, Name) :-
    !,
    findall(Short-Id, ( member(Id, Ids), short(Id, Short) ), Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    member(Short-Called, Groups),
    (   Called = [_]
    ->  Name = Short
    ;   member(Name, Called)
    ).
offered(_, _, Names, Name) :-
    member(Name, Names),
    atom(Name).

short(Id, Short) :-
    sub_atom(Id, Before, _, _, '.'),
    !,
    sub_atom(Id, 0, Before, _, Short).

%   completion(+Style, +Kind, +Name, +After, -Text): Text is Name in the syntax
%   in which users type it.

completion(quoted, _, Name, After, Text) :-
    (   sub_atom(After, 0, _, _, '\'')
    ->  Text = Name
    ;   atom_concat(Name, '\'', Text)
    ).
completion(plain, Kind, Name, _, Text) :-
    typed(Kind, Name, Term),
    format(atom(Text), '~q', [Term]).

typed(Kind, Name, Term) :-
    memberchk(Kind, [agents, payloads]),
    !,
    atomic_list_concat([First|Parts], /, Name),
    foldl([Part,Path,Path/Part]>>true, Parts, First, Term).
typed(_, Name, Name).

                /*******************************
                *      BEFORE THE CURSOR       *
                *******************************/

%   cursor(+Open, -Place, -Style, -Typed)//: the text ends in the argument
%   Place, Functor-Argument, of a term; Typed is the part of a name that was
%   typed there, after a quote if Style is `quoted`.  Open are the terms that the
%   text before has begun, each with its present argument, the innermost first.

cursor(Open, Place, Style, Typed) -->
    typed_codes(in_plain, Codes),
    after_name(Open, Codes, Place, Style, Typed).

after_name([Place|_], Codes, Place, plain, Typed) -->
    eos,
    !,
    { atom_codes(Typed, Codes) }.
after_name([Place|_], _, Place, quoted, Typed) -->
    "'",
    typed_codes(in_quotes, Codes),
    eos,
    !,
    { atom_codes(Typed, Codes) }.
after_name(Open0, Codes, Place, Style, Typed) -->
    [Code],
    rest_of(Code),
    { ( bracket(Code, Codes, Open0, Open1) -> Open = Open1 ; Open = Open0 ) },
    cursor(Open, Place, Style, Typed).

rest_of(Quote) -->
    { memberchk(Quote, `'"`) },
    !,
    string_without([Quote], _),
    [Quote].
rest_of(_) -->
    [].

bracket(0'(, Codes, Open, [Functor-1|Open]) :-
    atom_codes(Functor, Codes).
bracket(0',, _, [Functor-N0|Open], [Functor-N|Open]) :-
    N is N0+1.
bracket(Code, _, Open, [''-1|Open]) :-
    memberchk(Code, `[{`).
bracket(Code, _, [_|Open], Open) :-
    memberchk(Code, `)]}`).

typed_codes(Class, [Code|Codes]) -->
    [Code],
    { call(Class, Code) },
    !,
    typed_codes(Class, Codes).
typed_codes(_, []) -->
    [].

in_plain(Code) :-
    code_type(Code, csym).
in_plain(0'/).

in_quotes(Code) :-
    in_plain(Code).
in_quotes(Code) :-
    memberchk(Code, `.@:-`).
