:- module(typhon_compiling,
          [ compiling_begin/1,          % -Flags
            compiling_end/1,            % +Flags
            compiling_load/1            % +Files
          ]).
:- use_module(library(debug), []).      % from 9.2 on it defines a flag
:- use_module(library(lists), [member/2]).

/** <module> How the library is compiled

Arithmetic is compiled; debug/3 is kept. Predicates are imported, or declared
by autoload/2, and not searched for: with a search library(settings) would load
library(predicate_options), which takes as long as ten modules of this library.

*Threading*: any thread; the flags are those of the thread.
*/

%!  compiling_begin(-Flags:list) is det.
%
%   Files that this thread loads from now on are compiled with these flags.
%   Flags restores the former ones, see compiling_end/1.

compiling_begin(Flags) :-
    findall(Name=Value,
            ( flag(Name, _), current_prolog_flag(Name, Value) ), Flags),
    forall(flag(Name, Value), set_prolog_flag(Name, Value)).

%!  compiling_end(+Flags:list) is det.

compiling_end(Flags) :-
    forall(member(Name=Value, Flags), set_prolog_flag(Name, Value)).

%!  compiling_load(+Files:list) is det.
%
%   Load Files with these flags, and import nothing from them.

compiling_load(Files) :-
    setup_call_cleanup(
        compiling_begin(Flags),
        forall(member(File, Files), use_module(File, [])),
        compiling_end(Flags)).

flag(optimise, true).
flag(optimise_debug, false).
flag(autoload, explicit).
