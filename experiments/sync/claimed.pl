:- module(sync_claimed,
          [ gather_claims/2,            % +Directory, -Claims
            figures_sentence/2          % +Claims, -Sentence
          ]).
:- use_module('../lib/report', [save_csv/3]).
:- use_module(scenarios, [figure/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).

/** <module> The claims of all figures in one table

*Threading*: no state; any thread.
*/

%!  gather_claims(+Directory, -Claims) is det.
%
%   Claims are pairs Figure-Claim: the claims of all figures that have been
%   made in Directory.  They are written there as claims.csv and claims.md.

gather_claims(Directory, Claims) :-
    findall(Figure-Claim, figure_claim(Directory, Figure, Claim), Claims),
    findall([Figure, Verdict, Text, Found],
            ( member(Figure-claim(Text, Held, Found), Claims),
              verdict(Held, Verdict)
            ),
            Rows),
    directory_file_path(Directory, 'claims.csv', Csv),
    save_csv(Csv, [figure, verdict, claim, found], Rows),
    directory_file_path(Directory, 'claims.md', Markdown),
    save_markdown(Markdown, Rows).

%!  figures_sentence(+Claims, -Sentence) is det.
%
%   Sentence says how many of Claims, pairs Figure-Claim, held, and of
%   which figures did not.

figures_sentence(Claims, Sentence) :-
    length(Claims, All),
    aggregate_all(count, member(_-claim(_, false, _), Claims), Failed),
    (   Failed =:= 0
    ->  format(atom(Sentence), 'All ~d claims held.', [All])
    ;   findall(Part, failed_part(Claims, Part), Parts),
        atomic_list_concat(Parts, ', ', Text),
        format(atom(Sentence), '~d of ~d claims did not hold: ~w.',
               [Failed, All, Text])
    ).

failed_part(Claims, Part) :-
    figure(Figure, _),
    aggregate_all(count, member(Figure-claim(_, false, _), Claims), Failed),
    Failed > 0,
    aggregate_all(count, member(Figure-_, Claims), All),
    format(atom(Part), '~d of the ~d of Figure ~w', [Failed, All, Figure]).

figure_claim(Directory, Figure, claim(Text, Held, Found)) :-
    figure(Figure, _),
    format(atom(Name), '~w/figure-~w/claims.pl', [Directory, Figure]),
    exists_file(Name),
    read_file_to_terms(Name, Claims, [encoding(utf8)]),
    member(claim(Text, Held, Found), Claims).

verdict(true, held).
verdict(false, 'did not hold').

save_markdown(File, Rows) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        ( format(Out, '| figure | claim | verdict | found |~n\c
| --- | --- | --- | --- |~n', []),
          forall(member([Figure, Verdict, Text, Found], Rows),
                 format(Out, '| ~w | ~w | ~w | ~w |~n',
                        [Figure, Text, Verdict, Found]))
        ),
        close(Out)).
