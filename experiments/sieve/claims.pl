:- module(sieve_claims,
          [ sieve_claims/3,             % +Figure, +Runs, -Claims
            kind_name/2                 % +Kind, -Name
          ]).
:- use_module(rounds, [born/4, population/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists),
              [append/3, max_list/2, member/2, memberchk/2, min_list/2]).

/** <module> What thesis section 3.6 says of Figures 3.3 to 3.5

*Threading*: pure.
*/

%!  sieve_claims(+Figure, +Runs, -Claims) is det.
%
%   Claims are for print_claims/2.  Runs are pairs Seed-Rounds.  A claim
%   held if it did in each of them; what was found says in how many it did.

sieve_claims(Figure, Runs, Claims) :-
    findall(claim(Text, Held, Found),
            ( statement(Figure, Text, Test),
              judged(Runs, Test, Held, Found)
            ),
            Claims).

judged(Runs, Test, Held, Found) :-
    findall(Verdict-Note,
            ( member(_-Rounds, Runs), tried(Test, Rounds, Verdict, Note) ),
            Pairs),
    findall(Note, member(_-Note, Pairs), Notes),
    atomic_list_concat(Notes, '; ', Values),
    length(Pairs, Count),
    aggregate_all(count, member(true-_, Pairs), HeldCount),
    format(atom(Found), 'in ~d of ~d runs (~w)', [HeldCount, Count, Values]),
    (   HeldCount =:= Count
    ->  Held = true
    ;   Held = false
    ).

tried(Test, Rounds, Verdict, Note) :-
    test(Test, Rounds, Values, Goal),
    (   call(Goal)
    ->  Verdict = true
    ;   Verdict = false
    ),
    atomic_list_concat(Values, ' ', Note).

%!  kind_name(+Kind, -Name) is det.
%
%   An antibody as an atom: its bits, or what else it is.

kind_name(Kind, Name) :-
    (   maplist(atomic, Kind)
    ->  atomic_list_concat(Kind, Name)
    ;   term_to_atom(Kind, Name)
    ).

                /*******************************
                *          STATEMENTS          *
                *******************************/

%   statement(?Figure, -Text, -Test)

statement('3.3', 'the complements of the antigens are the three largest \c
populations in the end', leaders(['11111', '00000', '01010'])).
statement('3.3', 'no other kind has more than 3 in the end',
          others(['11111', '00000', '01010'], 3)).
statement('3.3', 'at most 16 kinds in all', kinds(16)).
statement('3.3', 'no new kind after round 5', new_kinds(5)).
statement('3.3', 'of clones made after round 5, nine in ten are of the \c
complements', clones(['11111', '00000', '01010'], 0.9)).
statement('3.4', '11110 has the largest population from round 5 on',
          leads('11110', 5, 15)).
statement('3.4', '11110 is more than half of all in the end',
          share('11110', 15, 0.5)).
statement('3.4', '11110 makes clones in each of rounds 5 to 15',
          cloning('11110', 5, 15)).
statement('3.4', '11111 is the second in the end', second('11111')).
statement('3.5', '11110 has the largest population at round 5',
          leads('11110', 5, 5)).
statement('3.5', '11110 has at most half of that at round 10',
          wanes('11110', 5, 10, 0.5)).
statement('3.5', '00010 has the largest population at round 10',
          leads('00010', 10, 10)).

%   test(+Test, +Rounds, -Values, -Goal): Values were found; the test holds
%   if Goal does.

test(leaders(Names), Rounds, Values, Values0 == Sorted) :-
    final(Rounds, Population),
    first(3, Population, Three),
    findall(Name, member(_-Name, Three), Found),
    msort(Found, Values0),
    msort(Names, Sorted),
    findall(Value, ( member(N-Name, Three), value(Name, N, Value) ), Values).
test(others(Names, Most), Rounds, [Max], Max =< Most) :-
    final(Rounds, Population),
    findall(N, ( member(N-Name, Population), \+ memberchk(Name, Names) ),
            Ns),
    max_list([0|Ns], Max).
test(kinds(Most), Rounds, [Count], Count =< Most) :-
    aggregate_all(count, Kind, distinct_kind(Rounds, Kind), Count).
test(new_kinds(Last), Rounds, [Round], Round =< Last) :-
    findall(First,
            ( distinct_kind(Rounds, Kind),
              aggregate_all(min(R), born(Rounds, R, _, Kind), First) ),
            Firsts),
    max_list(Firsts, Round).
test(clones(Names, Share), Rounds, [Part, of, Total], Part >= Share*Total) :-
    findall(Name,
            ( born(Rounds, R, clone, Kind), R > 5, kind_name(Kind, Name) ),
            All),
    length(All, Total),
    aggregate_all(count, ( member(Name, All), memberchk(Name, Names) ), Part).
test(leads(Name, From, To), Rounds, Values, Failing == []) :-
    findall(R, ( between(From, To, R), \+ first_is(Rounds, R, Name) ),
            Failing),
    (   Failing == []
    ->  at_end(Rounds, To, Values)
    ;   Values = ['not in rounds'|Failing]
    ).
test(share(Name, Round, Least), Rounds, [Count, of, Total],
     Count >= Least*Total) :-
    named_population(Rounds, Round, Population),
    aggregate_all(sum(N), member(N-_, Population), Total),
    count_of(Name, Population, Count).
test(cloning(Name, From, To), Rounds, [least, Least], Least > 0) :-
    findall(Count,
            ( between(From, To, R),
              aggregate_all(count, ( born(Rounds, R, clone, Kind),
                                     kind_name(Kind, Name) ), Count) ),
            Counts),
    min_list(Counts, Least).
test(second(Name), Rounds, [Value], Found == Name) :-
    final(Rounds, Population),
    (   Population = [_, N-Found|_]
    ->  value(Found, N, Value)
    ;   Found = none,
        Value = none
    ).
test(wanes(Name, From, To, Most), Rounds, [Before, to, After],
     After =< Most*Before) :-
    named_population(Rounds, From, Population0),
    named_population(Rounds, To, Population),
    count_of(Name, Population0, Before),
    count_of(Name, Population, After).

distinct_kind(Rounds, Kind) :-
    findall(K, born(Rounds, _, _, K), Kinds0),
    sort(Kinds0, Kinds),
    member(Kind, Kinds).

first_is(Rounds, Round, Name) :-
    named_population(Rounds, Round, Population),
    Population = [Most-_|_],
    memberchk(Most-Name, Population).

at_end(Rounds, Round, [Value]) :-
    named_population(Rounds, Round, [N-Name|_]),
    value(Name, N, Value).

final(Rounds, Population) :-
    length(Rounds, Last),
    named_population(Rounds, Last, Population).

named_population(Rounds, Round, Population) :-
    population(Rounds, Round, Population0),
    findall(N-Name, ( member(N-Kind, Population0), kind_name(Kind, Name) ),
            Population).

count_of(Name, Population, Count) :-
    (   memberchk(Count0-Name, Population)
    ->  Count = Count0
    ;   Count = 0
    ).

value(Name, N, Value) :-
    format(atom(Value), '~w: ~w', [Name, N]).

first(N, List, First) :-
    length(First, N),
    append(First, _, List),
    !.
first(_, List, List).
