:- module(typhon_page_operators,
          [ mechanism_run/4             % +Mechanism, +Name, +Arguments,
                                        % -Results
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2, type_error/2]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(mechanisms, [mechanism_file/2]).
:- use_module(protocol, [text/2]).
:- use_module(terms, [read_text/3]).

/** <module> Operators of mechanisms are called

A program of `agents/` stands above the page: it is loaded when it is wanted.

*Threading*: any thread.
*/

%!  mechanism_run(+Mechanism, +Name, +Arguments:list, -Results) is det.
%
%   Call the predicate Name of the operator of Mechanism.  An argument is text,
%   read as Prolog; a list of addresses; or empty, if it is to be told: Results
%   are texts of these.
%
%   @error existence_error(mechanism, Mechanism), existence_error(procedure, PI)
%   @error page_failed(PI), and what the operator raises

mechanism_run(Mechanism, Name, Arguments, Results) :-
    operator(Mechanism, Module),
    maplist(argument, Arguments, Terms),
    length(Terms, Arity),
    module_property(Module, exports(Exports)),
    (   memberchk(Name/Arity, Exports)
    ->  true
    ;   existence_error(procedure, Name/Arity)
    ),
    findall(N, nth_unbound(N, Terms), Unbound),
    Goal =.. [Name|Terms],
    (   call(Module:Goal)
    ->  findall(Text, ( member(N, Unbound),
                        arg(N, Goal, Term),
                        text(Term, Text) ), Results)
    ;   throw(error(page_failed(Name), _))
    ).

operator(Mechanism, Module) :-
    (   mechanism_file(Mechanism, File)
    ->  load_files(File, [if(not_loaded), imports([])]),
        module_property(Module, file(File))
    ;   existence_error(mechanism, Mechanism)
    ).

nth_unbound(N, Terms) :-
    nth1(N, Terms, Term),
    var(Term).

argument(Hosts, Terms), is_list(Hosts) =>
    maplist(address, Hosts, Terms).
argument("", _) =>
    true.
argument(Text, Term), string(Text) =>
    read_text(argument, Text, Term).
argument(Other, _) =>
    type_error(text, Other).

address(Text, Address) :-
    atom_string(Address, Text).
