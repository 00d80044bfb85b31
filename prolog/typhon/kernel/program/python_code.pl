:- module(typhon_python_code,
          [ python_payload/2,           % +Spec, -Payload
            payload_python/3            % +Payload, -Name, -Source
          ]).
:- autoload(library(readutil), [read_file_to_string/3]).
:- use_module(paths, []).

/** <module> Payloads that are Python

A payload that was read from a file vision.py is called `vision`; its one
clause is a fact 'vision.py'(Source).  So it travels as any other payload,
and is text for a host without Python.

*Threading*: no state.
*/

%!  python_payload(+Spec, -Payload) is semidet.
%
%   Fails if Spec does not end in `.py`.
%
%   @error existence_error(source_sink, Spec)

python_payload(Spec, payload(Name, [Functor/1], [(Fact:-true)])) :-
    base(Spec, Base),
    file_name_extension(Name, py, Base),
    absolute_file_name(Spec, File, [access(read)]),
    read_file_to_string(File, Source, [encoding(utf8)]),
    functor_of(Name, Functor),
    Fact =.. [Functor, Source].

base(Spec, Base) :-
    compound(Spec),
    compound_name_arguments(Spec, _, [Path]),
    !,
    base(Path, Base).
base(Spec, Base) :-
    ( atom(Spec) ; string(Spec) ),
    file_base_name(Spec, Base).

functor_of(Name, Functor) :-
    atom_concat(Name, '.py', Functor).

%!  payload_python(+Payload, -Name, -Source:string) is semidet.
%
%   Payload is Python.

payload_python(payload(Name, [Functor/1], [Clause]), Name, Source) :-
    functor_of(Name, Functor),
    Clause = (Fact:-true),
    Fact =.. [Functor, Source],
    string(Source).
