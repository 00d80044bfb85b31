:- module(typhon_afresh,
          [ raising_afresh/1            % :Goal
          ]).

/** <module> Errors that do not open the debugger

An error that passes a cleanup handler, as of setup_call_cleanup/3, on its
way to the top level opens the debugger there, which takes the next line
for its answer.  A public predicate with one inside raises its errors anew.

*Threading*: any thread.
*/

:- meta_predicate raising_afresh(0).

%!  raising_afresh(:Goal) is semidet.
%
%   Run Goal once; what it raises is raised again from here.

raising_afresh(Goal) :-
    catch(Goal, Ball, throw(Ball)),
    !.
