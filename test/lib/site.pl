:- module(test_made_site,
          [ site/1                      % -Dir
          ]).
:- use_module(common, [project_file/2, run_swipl/5]).
:- use_module(made_once, [made_once/3]).
:- use_module(library(debug), [assertion/1]).

/** <module> The site of the documents

*Threading*: the main thread.
*/

%!  site(-Dir) is det.
%
%   Dir has the site, made as the user makes it, once for all suites.

:- table site/1.

site(Dir) :-
    made_once(site, test_made_site:make, Dir).

make(Dir) :-
    project_file('doc/site.pl', Program),
    run_swipl([Program, --, Dir], [cwd('/'), timeout(300)], Status, Out, Err),
    assertion(made(Status, Out, Err) == made(exit(0), "", "")).
