------- A small turbine on land, for the tests ---------------------------------
Floating MHK turbine, by its title; names and layout as OpenFAST's, values invented
         3.01  TMax            - Total run time (s)
        0.01   DT              - Time step (s)
------ switches ---
          2    CompElast       - {1: ElastoDyn; 2: with BeamDyn}
          1    CompInflow      - switch
          2    CompAero        - switch
          1    CompServo       - switch
          0    CompHydro       - switch
       9.81    Gravity         - (m/s^2)
        1.2    AirDens         - (kg/m^3)
"parts/elasto.dat"   EDFile       - ElastoDyn
"parts/beam.dat"     BDBldFile(1) - BeamDyn
"parts/beam.dat"     BDBldFile(2) - BeamDyn
"parts/beam.dat"     BDBldFile(3) - BeamDyn
"parts/wind.dat"     InflowFile   - wind
'parts\aero.dat'     AeroFile     - AeroDyn
"parts/servo.dat"    ServoFile    - ServoDyn
