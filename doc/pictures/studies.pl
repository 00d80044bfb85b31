:- module(doc_pictures_studies,
          [ study_pictures/1,           % +Directory
            study_picture/3             % ?File, -Study, -Plot
          ]).
:- use_module(library(filesex), [copy_file/2, directory_file_path/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(process), [process_create/3]).

/** <module> Pictures of what studies have measured

*Threading*: the main thread.
*/

%!  study_picture(?File, -Study, -Plot) is nondet.
%
%   File, which documents show, is the plot Plot of Study.

study_picture('synchronisation.png',     demo,     demo).
study_picture('penalty-bias.png',        '5.6',    '5.6').
study_picture('hierarchy.png',           lead,     lead_deltas).
study_picture('pole.png',                pole,     '5.14').
study_picture('population.png',          '6.4',    '6.4').
study_picture('surface.png',             surface,  surface).
study_picture('sieve-complements.png',   '3.3',    '3.3').
study_picture('sieve-generic.png',       '3.4',    '3.4').
study_picture('sieve-switch.png',        '3.5',    '3.5').
study_picture('sieve-memory.png',        memory,   memory).
study_picture('sieve-return.png',        return,   return).
study_picture('sieve-programs.png',      programs, programs).
study_picture('algorithms-cloning.png',  cloning,  cloning).
study_picture('algorithms-crews.png',    crews,    crews).
study_picture('algorithms-exchange.png', exchange, exchange).
study_picture('algorithms-islands.png',  islands,  islands).
study_picture('algorithms-mixed.png',    mixed,    mixed).
study_picture('algorithms-settings.png', settings, settings).
study_picture('fleet-away.png',          away,     away).

%!  study_pictures(+Directory) is det.
%
%   Make ten runs of each study, or as many as RUNS of the environment says,
%   below out/pictures; what is there is not made again.

study_pictures(Directory) :-
    module_property(doc_pictures_studies, file(Here)),
    absolute_file_name('../../experiments/study.pl', Command,
                       [relative_to(Here)]),
    absolute_file_name('../../out/pictures', Out, [relative_to(Here)]),
    ( getenv('RUNS', Runs) -> true ; Runs = 10 ),
    findall(Study, study_picture(_, Study, _), Studies),
    append(Studies, ['--runs', Runs, '--out', Out], Arguments),
    process_create(path(swipl), [Command, '--'|Arguments], []),
    forall(study_picture(File, Study, Plot),
           copy_picture(Out, Study, Plot, Directory, File)).

copy_picture(Out, Study, Plot, Directory, File) :-
    format(atom(From), '~w/~w/~w.png', [Out, Study, Plot]),
    directory_file_path(Directory, File, To),
    copy_file(From, To),
    format('~w~n', [To]).
