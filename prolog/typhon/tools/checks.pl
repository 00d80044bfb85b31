:- module(typhon_checks,
          [ agent_check/1,              % +Spec
            agent_check/2               % +Spec, +Options
          ]).
:- autoload('checks/check', [check_program/1, check_program/2]).

/** <module> What is wrong with a program, for people

This is the interface of the layer.  Its modules are loaded when a program is
checked or read from a file for the first time.

*Threading*: any thread.
*/

%!  agent_check(+Spec) is det.
%
%   Print what is wrong with an agent program, or with a payload.  Errors
%   would keep it from loading.  Warnings are
%
%     - variables that occur once, and clauses of a predicate with others in
%       between
%     - predicates that it changes, and has not declared as its state
%     - choices that it gives up when it stops, and seems to count on
%     - of an agent, calls to predicates that neither it nor the vocabulary
%       defines, so that a place or a payload must offer them
%
%   While some of it cannot be read, only syntax errors are reported.
%   agent_create/3 raises the errors, and prints the warnings once for each
%   program, until its file changes; those of the last kind unless a payload of
%   the agent or the place of a host of this process defines the predicate.

agent_check(Spec) :-
    check_program(Spec).

%!  agent_check(+Spec, +Options) is semidet.
%
%   Options say where the program or the payload is to run.  With the option
%   policy(Policy), see host_start/2, what a host with that policy would refuse
%   is reported as errors, and agent_check/2 fails if there is any.

agent_check(Spec, Options) :-
    check_program(Spec, Options).
