:- module(experiment_report,
          [ print_table/3,              % +Stream, +Header, +Rows
            print_options/3,            % +Stream, +Options, +Hidden
            print_settings/3,           % +Stream, +Defaults, +Settings
            print_claims/2,             % +Stream, +Claims
            claims_sentence/2,          % +Claims, -Sentence
            save_csv/3,                 % +File, +Header, +Rows
            save_facts/2                % +File, +Facts
          ]).
:- use_module(library(apply), [foldl/4, maplist/3, maplist/4]).
:- use_module(library(csv), [csv_write_file/2]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> What an experiment prints and writes

Tables for people, CSV for other programs, facts for Prolog.

A claim is a term claim(Text, Held, Found): a statement of the thesis as a
line of text, `true` or `false`, and what was found, as text.

*Threading*: no state; any thread.
*/

%!  print_table(+Stream, +Header, +Rows) is det.
%
%   Rows are lists of cells, atoms or numbers, as many as Header has.  The
%   columns are right aligned.

print_table(Stream, Header, Rows0) :-
    maplist(maplist(cell), Rows0, Rows),
    Lines = [Header|Rows],
    widths(Lines, Widths),
    forall(member(Line, Lines), print_row(Stream, Widths, Line)).

cell(Cell, Text) :-
    (   float(Cell)
    ->  format(atom(Text), '~2f', [Cell])
    ;   format(atom(Text), '~w', [Cell])
    ).

widths([Line|Lines], Widths) :-
    maplist(atom_length, Line, Widths0),
    foldl(widen, Lines, Widths0, Widths).

widen(Line, Widths0, Widths) :-
    maplist(atom_length, Line, Lengths),
    maplist(wider, Widths0, Lengths, Widths).

wider(Width0, Length, Width) :-
    Width is max(Width0, Length).

print_row(Stream, Widths, Line) :-
    maplist(print_cell(Stream), Widths, Line),
    nl(Stream).

print_cell(Stream, Width, Text) :-
    Column is Width + 2,
    format(atom(Cell), '~t~w~*|', [Text, Column]),
    write(Stream, Cell).

%!  print_options(+Stream, +Options, +Hidden:list(atom)) is det.
%!  print_settings(+Stream, +Defaults, +Settings) is det.
%
%   Tables of Options, but for those that are named in Hidden, and of what
%   agents have: Defaults and Settings are pairs Name-Value, the latter
%   taking the place of the former.

print_options(Stream, Options, Hidden) :-
    findall([Name, Text],
            ( member(Option, Options), Option =.. [Name, Value],
              \+ memberchk(Name, Hidden),
              term_to_atom(Value, Text) ),
            Rows0),
    sort(Rows0, Rows),
    print_table(Stream, [parameter, value], Rows).

print_settings(Stream, Defaults, Settings) :-
    findall([Name, Value],
            ( member(Name-Default, Defaults),
              in_force(Name, Default, Settings, Value) ),
            Rows),
    print_table(Stream, ['of the agents', value], Rows).

in_force(Name, _, Settings, Value) :-
    memberchk(Name-Given, Settings),
    !,
    Value = Given.
in_force(_, Value, _, Value).

%!  print_claims(+Stream, +Claims) is det.
%
%   One line for each claim.

print_claims(Stream, Claims) :-
    forall(member(claim(Text, Held, Found), Claims),
           ( verdict(Held, Verdict),
             format(Stream, '  ~w~t~16|~w: ~w~n', [Verdict, Text, Found]) )).

verdict(true, 'held').
verdict(false, 'DID NOT HOLD').

%!  claims_sentence(+Claims, -Sentence) is det.
%
%   Sentence says in plain words whether the claims held.

claims_sentence(Claims, Sentence) :-
    length(Claims, Count),
    findall(Text, member(claim(Text, false, _), Claims), Failed),
    length(Failed, FailedCount),
    (   FailedCount =:= 0
    ->  format(atom(Sentence), 'All ~d claims held.', [Count])
    ;   atomic_list_concat(Failed, '; ', Texts),
        format(atom(Sentence), '~d of ~d claims did not hold: ~w.',
               [FailedCount, Count, Texts])
    ).

%!  save_csv(+File, +Header, +Rows) is det.
%
%   Write rows of atomic values, under a line of column names.

save_csv(File, Header, Rows) :-
    maplist(csv_row, [Header|Rows], Lines),
    csv_write_file(File, Lines).

csv_row(Cells, Row) :-
    Row =.. [row|Cells].

%!  save_facts(+File, +Facts) is det.
%
%   Write facts that can be consulted again.

save_facts(File, Facts) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Fact, Facts),
               format(Out, '~q.~n', [Fact])),
        close(Out)).
