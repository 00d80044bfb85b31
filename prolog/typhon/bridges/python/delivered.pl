:- module(typhon_python_delivered, []).
:- use_module('../common', [service/2, service_offer/4]).
:- use_module(service, [python_begin/2, python_forget/2, python_load/4]).

/** <module> Python that agents deliver

A payload that was read from a `.py` file is Python.  On hosts with the
option python(true) an agent may deliver it: the place has its functions as
predicates then, until somebody says undeliver/1.  It runs in the process
that python_start/3 has started, or in one that is started for it.

Python code can do whatever the user of this process may do.

*Threading*: whatever thread runs the agent.
*/

:- multifile
    typhon_starting:delivers/3,
    typhon_words:python_undelivered/2.

typhon_starting:delivers(Host, Name, Source) :-
    with_mutex(typhon_python, begun(Host)),
    module_name(Name, Module),
    python_load(Host, _{do:load, name:Module, source:Source}, PIs, Clauses),
    service_offer(Name, Host, PIs, Clauses).

begun(Host) :-
    (   service(python, Host)
    ->  true
    ;   python_begin(Host, [])
    ).

typhon_words:python_undelivered(Host, Name) :-
    service(python, Host),
    module_name(Name, Module),
    python_forget(Host, Module).

%   It replaces no file of that name.

module_name(Name, Module) :-
    atom_concat('payload ', Name, Module).
