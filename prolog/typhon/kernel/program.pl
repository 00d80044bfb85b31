:- module(typhon_program, []).

/** <module> Programs

Programs are installed here, and the machine executes their clauses.  This layer does not know of hosts or sockets.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(program/bodies,
            [ body_goals/4, clause_parts/3, control/1, control_of_system/1,
              control_use/2, control_written/2, goals_body/2, indicator_in/2,
              named/4, plain_goal/2, special/2 ]).
:- reexport(program/paths, [path_below/1]).
:- reexport(program/libraries,
            [ add_operators/2, declared_meta/3, file_beginning/2, is_import/1,
              library_file/2, prolog_file/3, with_scratch_module/2 ]).
:- reexport('program/reading').
:- reexport(program/code,
            [ code_install/3, code_receive/2, code_module/2, code_known/2,
              code_compiled/2, code_locate/2, code_names/2, code_places/2,
              code_program/2, code_sent/2, code_clear/0, code_make/3,
              code_extras/2, code_unwrapped/3, code_wrapped/3, native_body/4,
              place/3, program_hash/2, sent_program/2 ]).
:- reexport('program/mobile').
:- reexport(program/machine,
            [answer_at/3, machine_ready/1, machine_run/3]).
:- reexport(program/thread_state, [library_hook/0, machine_inside/0]).
:- reexport(program/faults,
            [fault/3, fault_note/1, fault_noted/1, frame_of/2]).
:- reexport(program/chunks, [place_left/4, plain_goals/2]).
