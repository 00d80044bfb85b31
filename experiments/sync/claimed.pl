:- module(sync_claimed,
          [ gather_claims/2             % +Directory, -Claims
          ]).
:- use_module('../lib/report', [save_csv/3]).
:- use_module(scenarios, [figure/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).

/** <module> The claims of all figures in one table

*Threading*: no state; any thread.
*/

%!  gather_claims(+Directory, -Claims) is det.
%
%   Claims are the claims of all figures that have been made in Directory,
%   each beginning with the number of its figure.  They are written there
%   as claims.csv and claims.md.

gather_claims(Directory, Claims) :-
    findall(Figure-Claim, figure_claim(Directory, Figure, Claim), Pairs),
    findall([Figure, Verdict, Text, Found],
            ( member(Figure-claim(Text, Held, Found), Pairs),
              verdict(Held, Verdict)
            ),
            Rows),
    directory_file_path(Directory, 'claims.csv', Csv),
    save_csv(Csv, [figure, verdict, claim, found], Rows),
    directory_file_path(Directory, 'claims.md', Markdown),
    save_markdown(Markdown, Rows),
    findall(claim(Full, Held, Found),
            ( member(Figure-claim(Text, Held, Found), Pairs),
              format(atom(Full), '~w ~w', [Figure, Text])
            ),
            Claims).

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
