:- module(robots_series,
          [ series_seeds/2,             % +Options, -Seeds
            series_directory/4,         % +Options, +Directory0, +Seed,
                                        % -Directory
            series_save/3,              % +Directory, +Options, +Claims
            series_end/2                % +Directory, +Claims
          ]).
:- use_module('../lib/report', [claims_sentence/2, save_facts/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [append/3, list_to_set/2, member/2, numlist/3]).
:- use_module(library(option), [option/2]).

/** <module> The same with several seeds

*Threading*: no state; any thread.
*/

%!  series_seeds(+Options, -Seeds:list(integer)) is det.
%
%   Those of seed(First) and runs(Count), which are required.

series_seeds(Options, Seeds) :-
    option(seed(First), Options),
    option(runs(Runs), Options),
    Last is First + Runs - 1,
    numlist(First, Last, Seeds).

%!  series_directory(+Options, +Directory0, +Seed, -Directory) is det.
%
%   Where the run with Seed is kept: with several runs each has a directory
%   of its own.

series_directory(Options, Directory, _, Directory) :-
    option(runs(1), Options),
    !.
series_directory(_, Directory0, Seed, Directory) :-
    atom_concat(seed, Seed, Part),
    directory_file_path(Directory0, Part, Directory).

%!  series_save(+Directory, +Options, +Claims) is det.
%
%   Writes metadata.pl: the parameters of a run, and what is claimed of it.
%   Of options that are there twice both are kept.

series_save(Directory, Options, Claims) :-
    findall(parameter(Name, Value),
            ( member(Option, Options), Option =.. [Name, Value] ),
            Parameters0),
    list_to_set(Parameters0, Parameters),
    append(Parameters, Claims, Facts),
    directory_file_path(Directory, 'metadata.pl', File),
    save_facts(File, Facts).

%!  series_end(+Directory, +Claims) is det.
%
%   Prints what came of it all, and where it is.

series_end(Directory, Claims) :-
    claims_sentence(Claims, Sentence),
    format('~n~w~nLogs, tables and pictures: ~w/~n', [Sentence, Directory]).
