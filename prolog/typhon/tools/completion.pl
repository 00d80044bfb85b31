:- module(typhon_completion,
          [ completed/4                 % +Before, +After, -Delete, -Completions
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(console_input), []).
:- use_module(library(lists), [member/2, reverse/2]).
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
    reverse(Codes, Reversed),
    phrase(started(Style, Delete), Reversed, Rest),
    phrase(argument(1, Functor, Argument), Rest, _),
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
    foldl(within, Parts, First, Term).
typed(_, Name, Name).

within(Part, Path, Path/Part).

                /*******************************
                *      BACK FROM THE CURSOR    *
                *******************************/

%   started(-Style, -Text)//: Text is the part of a name that was typed, after a
%   quote if Style is `quoted`.

started(quoted, Text) -->
    typed_codes(in_quotes, Codes),
    "'",
    !,
    { reversed_text(Codes, Text) }.
started(plain, Text) -->
    typed_codes(in_plain, Codes),
    { reversed_text(Codes, Text) }.

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

reversed_text(Codes, Text) :-
    reverse(Codes, Forward),
    atom_codes(Text, Forward).

%   argument(+N, -Functor, -Argument)//: the cursor is in the argument number
%   Argument of a term with the name Functor.  N counts the arguments, back from
%   the cursor.

argument(N, Functor, Argument) -->
    [Code],
    argument(Code, N, Functor, Argument).

argument(0'(, N, Functor, N) -->
    !,
    typed_codes(in_plain, [Code|Codes]),
    { reversed_text([Code|Codes], Functor) }.
argument(0',, N, Functor, Argument) -->
    !,
    { N1 is N+1 },
    argument(N1, Functor, Argument).
argument(Open, _, _, _) -->
    { memberchk(Open, `[{`),
      !,
      fail
    }.
argument(Close, N, Functor, Argument) -->
    { memberchk(Close, `)]}`) },
    !,
    group,
    argument(N, Functor, Argument).
argument(Quote, N, Functor, Argument) -->
    { memberchk(Quote, `'"`) },
    !,
    quoted(Quote),
    argument(N, Functor, Argument).
argument(_, N, Functor, Argument) -->
    argument(N, Functor, Argument).

group -->
    [Code],
    group(Code).

group(Open) -->
    { memberchk(Open, `([{`) },
    !.
group(Close) -->
    { memberchk(Close, `)]}`) },
    !,
    group,
    group.
group(Quote) -->
    { memberchk(Quote, `'"`) },
    !,
    quoted(Quote),
    group.
group(_) -->
    group.

quoted(Quote) -->
    [Code],
    (   { Code == Quote }
    ->  []
    ;   quoted(Quote)
    ).
