:- module(test_made_site,
          [ site/1                      % -Dir
          ]).
:- use_module(common, [project_file/2, run_swipl/5]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [delete_directory_and_contents/1]).

/** <module> The site of the documents

*Threading*: the main thread.
*/

:- dynamic made/1.

%!  site(-Dir) is det.
%
%   Dir has the site, made as the user makes it, once for all tests of a suite.

site(Dir) :-
    made(Dir),
    !.
site(Dir) :-
    tmp_file(typhon_site, Dir),
    project_file('doc/site.pl', Program),
    run_swipl([Program, --, Dir], [cwd('/'), timeout(300)], Status, Out, Err),
    assertion(made(Status, Out, Err) == made(exit(0), "", "")),
    assertz(made(Dir)),
    at_halt(delete_directory_and_contents(Dir)).
