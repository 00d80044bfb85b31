:- module(typhon_checks,
          [ agent_check/1,              % +Spec
            agent_check/2               % +Spec, +Options
          ]).
:- autoload('checks/check', [check_program/1, check_program/2]).

/** <module> Checks of programs and payloads

This is the interface of the layer.  Its modules are loaded when a program is
checked or read from a file for the first time.

*Threading*: any thread.
*/

%!  agent_check(+Spec) is det.
%
%   Print errors and warnings of an agent program, or of a payload.  A program
%   with errors does not load.  Warnings are about
%
%     - variables that occur once, and clauses of a predicate with others in
%       between
%     - predicates that the program changes, and does not declare as its state
%     - choice points that a stop discards, and on which the program seems to
%       rely
%     - for an agent, calls of predicates that neither the program nor the
%       vocabulary defines, so that a place or a payload must offer them
%
%   If a part cannot be read, only syntax errors are reported.  agent_create/3
%   raises the errors, and prints the warnings once for each program, until its
%   file changes.  It omits a warning of the last kind if a payload of the
%   agent, or the place of a host of this process, defines the predicate.

agent_check(Spec) :-
    check_program(Spec).

%!  agent_check(+Spec, +Options:list) is semidet.
%
%   Options describe the host on which the program or the payload will run.
%   With the option policy(Policy), see host_start/2, code that a host with that
%   policy would refuse is reported as errors, and agent_check/2 fails if there
%   are any.

agent_check(Spec, Options) :-
    check_program(Spec, Options).
