:- module(typhon_arguments,
          [ arguments_complete/2        % +Script, +Argv
          ]).
:- use_module(library(lists), [append/3, last/2]).

/** <module> Arguments that SWI-Prolog has taken

*Threading*: the main thread only.
*/

%!  arguments_complete(+Script, +Argv) is det.
%
%   Argv are all arguments of the file Script.  Without `--` before them,
%   SWI-Prolog loads those that are files, and leaves the others.
%
%   @error typhon_arguments(Script, Words): Words are to follow `--`

arguments_complete(Script, Argv) :-
    current_prolog_flag(os_argv, Words),
    append(Before, Argv, Words),
    last(Before, File),
    file_name_extension(_, Extension, File),
    Extension \== '',
    exists_file(File),
    \+ same_file(File, Script),
    append(_, [Loaded|Taken], Before),
    exists_file(Loaded),
    same_file(Loaded, Script),
    !,
    append(Taken, Argv, All),
    throw(error(typhon_arguments(Loaded, All), _)).
arguments_complete(_, _).

:- multifile prolog:error_message//1.

prolog:error_message(typhon_arguments(Script, Words)) -->
    { atomic_list_concat(Words, ' ', Text) },
    [ 'Arguments follow --: swipl ~w -- ~w'-[Script, Text] ].
