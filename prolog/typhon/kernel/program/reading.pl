:- module(typhon_reading,
          [ payload_file/1,             % +File
            payload_load/2,             % +Spec, -Payload
            payload_python/3,           % +Payload, -Name, -Source
            program_file/2,             % +Spec, -File
            program_load/6,             % +Spec, -Program, -Initial, -Hash,
                                        % -Kinds, -Places
            program_read/7              % +Spec, -Program, -Initial, -Kinds,
                                        % -Places, -Sources, -Doubtful
          ]).
:- use_module('../base/on_demand', [on_demand_call/3]).

/** <module> Reading of programs, which is loaded when it is first used

The predicates are those of typhon_programs and typhon_source.

*Threading*: any thread that may wait.
*/

%!  payload_file(+File) is semidet.
%!  payload_load(+Spec, -Payload) is det.
%!  payload_python(+Payload, -Name, -Source) is semidet.
%!  program_file(+Spec, -File) is det.
%!  program_load(+Spec, -Program, -Initial, -Hash, -Kinds, -Places) is det.
%!  program_read(+Spec, -Program, -Initial, -Kinds, -Places, -Sources,
%!               -Doubtful) is det.

payload_file(File) :-
    read_by(typhon_programs:payload_file(File)).

payload_load(Spec, Payload) :-
    read_by(typhon_programs:payload_load(Spec, Payload)).

payload_python(Payload, Name, Source) :-
    read_by(typhon_programs:payload_python(Payload, Name, Source)).

program_file(Spec, File) :-
    read_by(typhon_source:program_file(Spec, File)).

program_load(Spec, Program, Initial, Hash, Kinds, Places) :-
    read_by(typhon_programs:program_load(Spec, Program, Initial, Hash, Kinds,
                                         Places)).

program_read(Spec, Program, Initial, Kinds, Places, Sources, Doubtful) :-
    read_by(typhon_programs:program_read(Spec, Program, Initial, Kinds, Places,
                                         Sources, Doubtful)).

read_by(Goal) :-
    on_demand_call(program, text, Goal).
