:- module(typhon_helper_python,
          [ helper_python/2             % +Options, -Program
          ]).
:- use_module(library(option), [option/2]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> Which Python

*Threading*: any thread.
*/

:- setting(python, atom, '',
           "The Python of helpers; '' for that of the system").

%!  helper_python(+Options, -Program) is det.
%
%   Program is for process_create/3: that of python(Name) in Options, of the
%   setting, or that of the system, if it can be: one in the PATH may be a
%   front that hides the modules of the system, and is slow to start.

helper_python(Options, Python) :-
    (   option(python(Name), Options)
    ->  true
    ;   setting(python, Name)
    ),
    program(Name, Python).

program('', Python) :-
    !,
    (   exists_file('/usr/bin/python3')
    ->  Python = '/usr/bin/python3'
    ;   Python = path(python3)
    ).
program(Name, Name) :-
    is_absolute_file_name(Name),
    !.
program(Name, path(Name)).
